#pragma once
#include <cmath>

#include "physics/dem/laws/kinematics.hpp"

namespace talus::dem {

/// What the elasticity of a contact answers; friction and resistances are built on it.
template <class Real = double>
struct ElasticResponse {
    Real normal_force;          ///< along the normal, positive in repulsion, with damping [N]
    Real normal_stiffness;      ///< secant [N/m]
    Real tangential_stiffness;  ///< [N/m]
    Real tangential_damping;    ///< [N s/m]
    Real contact_radius;        ///< [m]
    Real earlier_stiffness;     ///< tangential stiffness a step ago over that of now, at most 1
};

/// Linear spring and dashpot: F_n = k_n d + gamma_n d', gamma_n = damping sqrt(k_n m*). P. A. Cundall,
/// O. D. L. Strack, Geotechnique 29 (1979) 47; restitution: damping.hpp.
template <class Real = double>
struct LinearSpring {
    Real normal_stiffness;      ///< k_n [N/m]
    Real tangential_stiffness;  ///< k_t [N/m]
    Real normal_damping;        ///< gamma_n / sqrt(k_n m*) [1]
    Real tangential_damping;    ///< gamma_t / sqrt(k_n m*) [1]
    Real least_force;           ///< normal forces below are cut: 0, or -infinity if damping may attract [N]

    ElasticResponse<Real> operator()(const ContactKinematics<Real>& k) const {
        using std::max, std::sqrt;
        const Real overlap = max(k.overlap, Real(0.0)), damping = sqrt(normal_stiffness * k.effective_mass);
        ElasticResponse<Real> r;
        r.normal_force = max(
            normal_stiffness * overlap - normal_damping * damping * dot(k.velocity, k.normal), least_force);
        r.normal_stiffness = normal_stiffness;
        r.tangential_stiffness = tangential_stiffness;
        r.tangential_damping = tangential_damping * damping;
        r.contact_radius = sqrt(k.effective_radius * overlap);
        r.earlier_stiffness = Real(1.0);
        return r;
    }
};

/// Hertz's normal force 4/3 E* a d and Mindlin's tangential stiffness 8 G* a, a = sqrt(R* d), damped by
/// gamma_n = damping sqrt(k_n m*) with the secant stiffness k_n = 4/3 E* a. H. Hertz, J. Reine Angew. Math.
/// 92 (1881) 156; R. D. Mindlin, J. Appl. Mech. 16 (1949) 259; damping: Y. Tsuji, T. Tanaka, T. Ishida,
/// Powder Technol. 71 (1992) 239, restitution: damping.hpp.
template <class Real = double>
struct HertzMindlin {
    Real effective_modulus;        ///< E*, 1/E* = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2 [Pa]
    Real effective_shear_modulus;  ///< G*, 1/G* = (2 - nu_1)/G_1 + (2 - nu_2)/G_2 [Pa]
    Real normal_damping;           ///< gamma_n / sqrt(k_n m*) [1]
    Real tangential_damping;       ///< gamma_t / sqrt(k_n m*) [1]
    Real least_force;              ///< as for LinearSpring [N]

    ElasticResponse<Real> operator()(const ContactKinematics<Real>& k) const {
        using std::max, std::sqrt;
        const Real overlap = max(k.overlap, Real(0.0)), approach = -dot(k.velocity, k.normal);
        const Real radius = sqrt(k.effective_radius * overlap);
        const Real stiffness = (4.0 / 3.0) * effective_modulus * radius;
        const Real damping = sqrt(stiffness * k.effective_mass);
        ElasticResponse<Real> r;
        r.normal_force = max(stiffness * overlap + normal_damping * damping * approach, least_force);
        r.normal_stiffness = stiffness;
        r.tangential_stiffness = 8 * effective_shear_modulus * radius;
        r.tangential_damping = tangential_damping * damping;
        r.contact_radius = radius;
        const Real growth = max(approach * k.time_step, Real(0.0));
        r.earlier_stiffness = sqrt(max(overlap - growth, Real(0.0)) / max(overlap, Real(1e-300)));
        return r;
    }
};

}  // namespace talus::dem
