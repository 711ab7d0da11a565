#pragma once
#include <array>

#include "physics/dem/vector3.hpp"

namespace talus::dem {

/// Swings as amplitude sin(2 pi frequency t + phase), from where it is at t = 0.
struct Oscillation {
    double frequency = 0;  ///< [Hz]
    double phase = 0;      ///< [rad]
};

/// Where a wall is: a place X of the wall at rest is at rotation (X - centre) + centre + shift.
struct WallPose {
    std::array<Vector3<>, 3> rows{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  ///< of the rotation
    Vector3<> centre, shift;                                           ///< [m]
    Vector3<> velocity;                                                ///< of what was at the centre [m/s]
    Vector3<> angular_velocity;                                        ///< [rad/s]

    Vector3<> turned(const Vector3<>& v) const { return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)}; }
    Vector3<> turned_back(const Vector3<>& v) const { return v.x * rows[0] + v.y * rows[1] + v.z * rows[2]; }
    /// A place of space as the wall at rest knows it.
    Vector3<> in_wall(const Vector3<>& place) const { return turned_back(place - centre - shift) + centre; }
    Vector3<> velocity_at(const Vector3<>& place) const {
        return velocity + cross(angular_velocity, place - centre - shift);
    }
};

/// Prescribed motion of a wall: translation, rotation about an axis that is carried along, and oscillations
/// of both, between two times; a function of time alone, so that a restart finds it again to the bit.
struct WallMotion {
    Vector3<> velocity;   ///< [m/s]
    Vector3<> amplitude;  ///< of the translation's oscillation [m]
    Oscillation translation_oscillation;
    Vector3<> centre;             ///< on the axis of rotation [m]
    Vector3<> axis{0, 0, 1};      ///< unit vector
    double angular_velocity = 0;  ///< about the axis, right-handed [rad/s]
    double angle_amplitude = 0;   ///< of the rotation's oscillation [rad]
    Oscillation rotation_oscillation;
    double begin = 0;    ///< when it sets out [s]
    double end = 1e300;  ///< when it stops where it is [s]

    WallPose pose(double time) const;
};

}  // namespace talus::dem
