#pragma once
#include "physics/dem/vector3.hpp"

namespace talus::dem {

/// One grain of a pair, for the laws.
template <class Real = double>
struct Grain {
    Vector3<Real> velocity;          ///< of its centre [m/s]
    Vector3<Real> angular_velocity;  ///< [rad/s]
    Real radius;                     ///< [m]
    Real mass;                       ///< [kg]
};

/// What a contact law is told of a pair, as its first side sees it. Seen from the second side every vector
/// but the angular velocities' sum changes its sign and nothing else changes, to the bit.
template <class Real = double>
struct ContactKinematics {
    Real overlap;                           ///< r_1 + r_2 - distance [m], negative across a gap
    Vector3<Real> normal;                   ///< unit vector from the second to the first
    Vector3<Real> velocity;                 ///< of the first relative to the second where they touch [m/s]
    Vector3<Real> angular_velocity;         ///< of the first relative to the second [rad/s]
    Vector3<Real> summed_angular_velocity;  ///< of the first plus the second [rad/s]
    Real effective_radius;                  ///< r_1 r_2 / (r_1 + r_2) [m]; r_1 at a plane wall
    Real effective_mass;                    ///< m_1 m_2 / (m_1 + m_2) [kg]; m_1 at a wall
    Real effective_inertia;  ///< I_1 I_2 / (I_1 + I_2), I = 7/5 m r^2 about the contact [kg m2]
    Real time_step;          ///< that the history is advanced by [s]
};

/// What a law answers: force on the first side at the contact point, and couple on it (rolling and twisting
/// resistance). The second side feels the negative of both.
template <class Real = double>
struct ContactLoad {
    Vector3<Real> force;   ///< [N]
    Vector3<Real> couple;  ///< [N m]
};

/// Distance from a grain's centre to the contact point, the middle of the overlap: the two arms of a pair add
/// up to the distance of the centres, so that its angular momentum is conserved.
template <class Real>
Real contact_arm(const Real& radius, const Real& overlap) {
    return radius - 0.5 * overlap;
}

/// Torque on a grain about its centre [N m], from its own side's normal and load. For the second side of a
/// pair pass the negatives of the first's.
template <class Real>
Vector3<Real> torque_about_centre(const Vector3<Real>& normal, const Real& arm,
                                  const ContactLoad<Real>& load) {
    return load.couple - arm * cross(normal, load.force);
}

/// Kinematics of two grains; `separation` is the vector from the second centre to the first and `distance`
/// its length, not zero.
template <class Real>
ContactKinematics<Real> grain_kinematics(const Vector3<Real>& separation, const Real& distance,
                                         const Grain<Real>& first, const Grain<Real>& second,
                                         Real time_step) {
    ContactKinematics<Real> k;
    const Real overlap = first.radius + second.radius - distance;
    k.overlap = overlap;
    k.normal = (1 / distance) * separation;
    const Vector3<Real> turning = contact_arm(first.radius, overlap) * first.angular_velocity +
                                  contact_arm(second.radius, overlap) * second.angular_velocity;
    k.velocity = first.velocity - second.velocity - cross(turning, k.normal);
    k.angular_velocity = first.angular_velocity - second.angular_velocity;
    k.summed_angular_velocity = first.angular_velocity + second.angular_velocity;
    // One division for both.
    const Real radii = first.radius + second.radius, masses = first.mass + second.mass;
    const Real inverse = 1 / (radii * masses);
    k.effective_radius = first.radius * second.radius * (masses * inverse);
    k.effective_mass = first.mass * second.mass * (radii * inverse);
    const Real inertia_1 = 1.4 * first.mass * first.radius * first.radius;
    const Real inertia_2 = 1.4 * second.mass * second.radius * second.radius;
    k.effective_inertia = inertia_1 * inertia_2 / (inertia_1 + inertia_2);
    k.time_step = time_step;
    return k;
}

/// Kinematics of a grain (the first side) on a wall: a grain of infinite radius and mass, that moves with
/// `wall_velocity` where they touch (at contact_arm from the centre) and turns with `wall_angular_velocity`.
/// `normal` points from the wall to the grain.
template <class Real>
ContactKinematics<Real> wall_kinematics(const Vector3<Real>& normal, const Real& overlap,
                                        const Grain<Real>& grain, const Vector3<Real>& wall_velocity,
                                        const Vector3<Real>& wall_angular_velocity, Real time_step) {
    ContactKinematics<Real> k;
    k.overlap = overlap;
    k.normal = normal;
    k.velocity = grain.velocity - wall_velocity -
                 cross(contact_arm(grain.radius, overlap) * grain.angular_velocity, normal);
    k.angular_velocity = grain.angular_velocity - wall_angular_velocity;
    k.summed_angular_velocity = grain.angular_velocity + wall_angular_velocity;
    k.effective_radius = grain.radius;
    k.effective_mass = grain.mass;
    k.effective_inertia = 1.4 * grain.mass * grain.radius * grain.radius;
    k.time_step = time_step;
    return k;
}

}  // namespace talus::dem
