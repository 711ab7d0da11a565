#pragma once
#include <cmath>
#include <cstddef>

#include "physics/dem/laws/friction.hpp"

namespace talus::dem {

/// A torque mu_r R* F_n against the relative rolling, whatever its speed; swings about zero where a grain
/// comes to rest. Model A of J. Ai, J.-F. Chen, J. M. Rotter, J. Y. Ooi, Powder Technol. 206 (2011) 269.
template <class Real = double>
struct ConstantRollingTorque {
    static constexpr std::size_t history_count = 0;
    Real coefficient;  ///< mu_r [1]

    Vector3<Real> operator()(const ContactKinematics<Real>& k, const ElasticResponse<Real>&, const Real& load,
                             Real*) const {
        using std::max;
        const Vector3<Real> rolling = tangential_part(k.angular_velocity, k.normal);
        const Real torque = coefficient * k.effective_radius * max(load, Real(0.0));
        return -(torque / max(norm(rolling), Real(1e-300))) * rolling;
    }
};

/// Elastic-plastic spring and dashpot: M = -k_r theta, k_r = 9/4 k_n (mu_r R*)^2, |k_r theta| <= mu_r R* F_n,
/// and while below that -2 eta sqrt(I k_r) theta' as well. Model C of J. Ai, J.-F. Chen, J. M. Rotter, J. Y.
/// Ooi, Powder Technol. 206 (2011) 269; k_r from K. Iwashita, M. Oda, J. Eng. Mech. 124 (1998) 285. Unlike
/// there the sum of both is capped too, or a grain that lands rolling would feel a multiple of the cap for a
/// moment.
template <class Real = double>
struct ElasticPlasticRolling {
    static constexpr std::size_t history_count = 3;  ///< rolling angle [rad]
    Real coefficient;                                ///< mu_r [1]
    Real damping;                                    ///< eta, 1 is critical [1]

    Vector3<Real> operator()(const ContactKinematics<Real>& k, const ElasticResponse<Real>& elastic,
                             const Real& load, Real* history) const {
        using std::max, std::min, std::sqrt;
        const Vector3<Real> stored{history[0], history[1], history[2]};
        const Vector3<Real> rolling = tangential_part(k.angular_velocity, k.normal);
        const Real arm = coefficient * k.effective_radius;
        const Real stiffness = 2.25 * elastic.normal_stiffness * arm * arm;
        const Real cap = arm * max(load, Real(0.0));
        Vector3<Real> angle = turned_with_contact(stored, k) + k.time_step * rolling;
        const Real spring = stiffness * norm(angle);
        const auto plastic = spring > cap;
        angle = select(plastic, cap / max(spring, Real(1e-300)), Real(1.0)) * angle;
        history[0] = angle.x;
        history[1] = angle.y;
        history[2] = angle.z;
        const Real dashpot = select(plastic, Real(0.0), 2 * damping * sqrt(k.effective_inertia * stiffness));
        const Vector3<Real> torque = -(stiffness * angle) - dashpot * rolling;
        return min(cap / max(norm(torque), Real(1e-300)), Real(1.0)) * torque;
    }
};

}  // namespace talus::dem
