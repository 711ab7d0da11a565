#pragma once
#include <cmath>
#include <cstddef>

#include "physics/dem/laws/elasticity.hpp"

namespace talus::dem {

/// Resistance of the contact area against relative spin about the normal: spring k_t a^2 / 2 and dashpot
/// gamma_t a^2 / 2, at most 2/3 a mu F_n. J. S. Marshall, J. Comput. Phys. 228 (2009) 1541, eqs 31-33.
template <class Real = double>
struct ContactAreaTwisting {
    static constexpr std::size_t history_count = 1;  ///< twist [rad]
    Real coefficient;                                ///< mu [1]

    Vector3<Real> operator()(const ContactKinematics<Real>& k, const ElasticResponse<Real>& elastic,
                             const Real& load, Real* history) const {
        using std::max, std::min;
        const Real a = elastic.contact_radius, half_area = 0.5 * a * a;
        const Real stiffness = half_area * elastic.tangential_stiffness;
        const Real cap = (2.0 / 3.0) * a * coefficient * max(load, Real(0.0));
        const Real rate = dot(k.angular_velocity, k.normal);
        const Real limit = cap / max(stiffness, Real(1e-300));
        const Real twist = max(min(history[0] + k.time_step * rate, limit), -limit);
        history[0] = twist;
        const Real trial = -stiffness * twist - half_area * elastic.tangential_damping * rate;
        return max(min(trial, cap), -cap) * k.normal;
    }
};

}  // namespace talus::dem
