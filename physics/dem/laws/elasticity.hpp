#pragma once
#include <cmath>
#include <cstddef>
#include <numbers>

#include "physics/dem/laws/kinematics.hpp"

namespace talus::dem {

/// What the elasticity of a contact answers; friction and resistances are built on it.
template <class Real = double>
struct ElasticResponse {
    decltype(Real() > Real()) touching;
    Real normal_force;          ///< along the normal, positive in repulsion, with damping [N]
    Real friction_load;         ///< what friction is measured with [N]
    Real normal_stiffness;      ///< secant, without adhesion [N/m]
    Real tangential_stiffness;  ///< [N/m]
    Real tangential_damping;    ///< [N s/m]
    Real contact_radius;        ///< [m]
    Real earlier_stiffness;     ///< tangential stiffness a step ago over that of now, at most 1
};

/// Linear spring and dashpot: F_n = k_n d + gamma_n d', gamma_n = damping sqrt(k_n m*). P. A. Cundall,
/// O. D. L. Strack, Geotechnique 29 (1979) 47; restitution: damping.hpp.
template <class Real = double>
struct LinearSpring {
    static constexpr bool sticks = false;
    Real normal_stiffness;      ///< k_n [N/m]
    Real tangential_stiffness;  ///< k_t [N/m]
    Real normal_damping;        ///< gamma_n / sqrt(k_n m*) [1]
    Real tangential_damping;    ///< gamma_t / sqrt(k_n m*) [1]
    Real least_force;           ///< normal forces below are cut: 0, or -infinity if damping may attract [N]

    ElasticResponse<Real> operator()(const ContactKinematics<Real>& k, const Real&) const {
        using std::max, std::sqrt;
        const Real overlap = max(k.overlap, Real(0.0)), damping = sqrt(normal_stiffness * k.effective_mass);
        ElasticResponse<Real> r;
        r.touching = k.overlap > 0;
        r.normal_force = max(
            normal_stiffness * overlap - normal_damping * damping * dot(k.velocity, k.normal), least_force);
        r.friction_load = r.normal_force;
        r.normal_stiffness = normal_stiffness;
        r.tangential_stiffness = tangential_stiffness;
        r.tangential_damping = tangential_damping * damping;
        r.contact_radius = sqrt(k.effective_radius * overlap);
        r.earlier_stiffness = Real(1.0);
        return r;
    }
    Real reach(const Real&) const { return Real(0.0); }
};

/// Hertz's normal force 4/3 E* a d and Mindlin's tangential stiffness 8 G* a, a = sqrt(R* d), damped by
/// gamma_n = damping sqrt(k_n m*) with the secant stiffness k_n = 4/3 E* a. H. Hertz, J. Reine Angew. Math.
/// 92 (1881) 156; R. D. Mindlin, J. Appl. Mech. 16 (1949) 259; damping: Y. Tsuji, T. Tanaka, T. Ishida,
/// Powder Technol. 71 (1992) 239, restitution: damping.hpp.
///
/// While the overlap grows the spring of friction stiffens. `keeps_force`: the force it bears stays, only
/// further slip meets the stiffer spring, so that pressing harder brings no energy (D. Elata, J. G. Berryman,
/// Mech. Mater. 24 (1996) 229). Otherwise its length stays and the force grows, as in other codes'
/// displacement histories: a little energy is gained where the contact sticks.
template <class Real, bool keeps_force>
struct HertzSpring {
    static constexpr bool sticks = false;
    Real effective_modulus;        ///< E*, 1/E* = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2 [Pa]
    Real effective_shear_modulus;  ///< G*, 1/G* = (2 - nu_1)/G_1 + (2 - nu_2)/G_2 [Pa]
    Real normal_damping;           ///< gamma_n / sqrt(k_n m*) [1]
    Real tangential_damping;       ///< gamma_t / sqrt(k_n m*) [1]
    Real least_force;              ///< as for LinearSpring [N]

    ElasticResponse<Real> operator()(const ContactKinematics<Real>& k, const Real&) const {
        using std::max, std::min, std::sqrt;
        const Real overlap = max(k.overlap, Real(0.0)), approach = -dot(k.velocity, k.normal);
        const Real radius = sqrt(k.effective_radius * overlap);
        const Real stiffness = (4.0 / 3.0) * effective_modulus * radius;
        const Real damping = sqrt(stiffness * k.effective_mass);
        ElasticResponse<Real> r;
        r.touching = k.overlap > 0;
        r.normal_force = max(stiffness * overlap + normal_damping * damping * approach, least_force);
        r.friction_load = r.normal_force;
        r.normal_stiffness = stiffness;
        r.tangential_stiffness = 8 * effective_shear_modulus * radius;
        r.tangential_damping = tangential_damping * damping;
        r.contact_radius = radius;
        r.earlier_stiffness = Real(1.0);
        if constexpr (keeps_force) {
            // sqrt(1 - growth/overlap) to third order; a contact that begins has nothing to keep.
            const Real growth = min(max(approach * k.time_step, Real(0.0)), overlap);
            r.earlier_stiffness = (overlap - 0.75 * growth) / max(overlap - 0.25 * growth, Real(1e-300));
        }
        return r;
    }
    Real reach(const Real&) const { return Real(0.0); }
};
template <class Real = double>
using HertzMindlin = HertzSpring<Real, true>;
template <class Real = double>
using HertzMindlinDisplacement = HertzSpring<Real, false>;

/// Adhesive elastic contact: F_n = 4 E* a^3/(3 R*) - sqrt(8 pi w E* a^3), d = a^2/R* - sqrt(2 pi w a/E*). It
/// forms where the surfaces meet and holds across a gap until the neck tears, at -d = 3 a_c^2/R*, a_c^3 = pi
/// w R*^2/(8 E*); the greatest pull is 3/2 pi w R*. K. L. Johnson, K. Kendall, A. D. Roberts, Proc. R. Soc. A
/// 324 (1971) 301. Friction is measured with F_n plus twice the greatest pull: C. Thornton, J. Phys. D 24
/// (1991) 1942. Tangential stiffness and damping as for HertzMindlin.
template <class Real = double>
struct JohnsonKendallRoberts {
    static constexpr bool sticks = true;  ///< a contact once made is a contact across a gap
    Real effective_modulus;               ///< E* [Pa]
    Real effective_shear_modulus;         ///< G* [Pa]
    Real normal_damping;                  ///< gamma_n / sqrt(k_n m*), k_n = 4/3 E* a [1]
    Real tangential_damping;              ///< gamma_t / sqrt(k_n m*) [1]
    Real work_of_adhesion;                ///< w [J/m2]

    ElasticResponse<Real> operator()(const ContactKinematics<Real>& k, const Real& touched) const {
        using std::max, std::sqrt;
        const Real R = k.effective_radius, approach = -dot(k.velocity, k.normal);
        const Real neck = sqrt((2 * std::numbers::pi) * work_of_adhesion / effective_modulus);
        const Real a = contact_radius(max(k.overlap, -reach(R)), R, neck);
        const Real stiffness = (4.0 / 3.0) * effective_modulus * a;
        const Real damping = sqrt(stiffness * k.effective_mass);
        const Real adhesion = 2 * effective_modulus * neck * a * sqrt(a);
        ElasticResponse<Real> r;
        r.touching = (k.overlap > 0) || (touched > 0 && k.overlap > -reach(R));
        r.normal_force = stiffness * a * a / R - adhesion + normal_damping * damping * approach;
        r.friction_load = r.normal_force + (3 * std::numbers::pi) * work_of_adhesion * R;
        r.normal_stiffness = stiffness;
        r.tangential_stiffness = 8 * effective_shear_modulus * a;
        r.tangential_damping = tangential_damping * damping;
        r.contact_radius = a;
        const Real slope = 2 * a / R - 0.5 * neck / sqrt(a);
        const Real growth = max(approach * k.time_step, Real(0.0)) / max(slope, Real(1e-300));
        r.earlier_stiffness = max(1 - growth / a, Real(0.0));
        return r;
    }

    /// Gap at which the neck tears [m].
    Real reach(const Real& effective_radius) const {
        using std::cbrt;
        const Real a = cbrt((0.125 * std::numbers::pi) * work_of_adhesion * effective_radius *
                            effective_radius / effective_modulus);
        return 3 * a * a / effective_radius;
    }

  private:
    /// The greater root of d = a^2/R* - neck sqrt(a), by Newton's method for s = sqrt(a) from above: s <= 2
    /// of the root at the start.
    static Real contact_radius(const Real& overlap, const Real& R, const Real& neck) {
        using std::cbrt, std::max, std::sqrt;
        Real s = sqrt(sqrt(R * max(overlap, Real(0.0)))) + cbrt(neck * R);
        for (int iteration = 0; iteration < 16; ++iteration) {
            const Real cube = s * s * s;
            s = s - max(s * cube - R * (neck * s + overlap), Real(0.0)) / (4 * cube - R * neck);
        }
        return s * s;
    }
};

}  // namespace talus::dem
