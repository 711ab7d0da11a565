#pragma once
#include <cmath>
#include <cstddef>

#include "physics/dem/laws/elasticity.hpp"

namespace talus::dem {

/// A displacement stored at an earlier step, turned with the contact: by the mean spin of the two sides about
/// the normal, and into the tangential plane of now without a change of its length.
template <class Real>
Vector3<Real> turned_with_contact(const Vector3<Real>& stored, const ContactKinematics<Real>& k) {
    return turned_into_plane(stored, k.normal, 0.5 * k.time_step * dot(k.summed_angular_velocity, k.normal));
}

/// Coulomb's friction with a tangential spring and dashpot: F_t = -k_t xi - gamma_t v_t, |F_t| <= mu F_n.
/// Where the cap is reached spring and dashpot are cut by the same share, so that the spring never bears more
/// than what is left of the cap by the dashpot. P. A. Cundall, O. D. L. Strack, Geotechnique 29 (1979) 47.
template <class Real = double>
struct CoulombFriction {
    static constexpr std::size_t history_count = 3;  ///< tangential displacement [m]
    Real coefficient;                                ///< mu [1]

    /// Force on the first side [N]; `load` is what presses the surfaces together [N].
    Vector3<Real> operator()(const ContactKinematics<Real>& k, const ElasticResponse<Real>& elastic,
                             const Real& load, Real* history) const {
        using std::max, std::min, std::sqrt;
        const Vector3<Real> stored{history[0], history[1], history[2]};
        const Vector3<Real> slip = tangential_part(k.velocity, k.normal);
        Vector3<Real> spring =
            elastic.earlier_stiffness * turned_with_contact(stored, k) + k.time_step * slip;
        const Vector3<Real> trial =
            -(elastic.tangential_stiffness * spring) - elastic.tangential_damping * slip;
        const Real cap = coefficient * max(load, Real(0.0));
        const Real share = min(cap / max(norm(trial), Real(1e-300)), Real(1.0));
        spring = share * spring;
        history[0] = spring.x;
        history[1] = spring.y;
        history[2] = spring.z;
        return share * trial;
    }
};

}  // namespace talus::dem
