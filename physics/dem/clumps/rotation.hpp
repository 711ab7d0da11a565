#pragma once
#include <array>

#include "physics/dem/vector3.hpp"

namespace talus::dem {

/// A rotation as a unit quaternion.
struct Quaternion {
    double scalar = 1;
    Vector3<> vector;

    friend Quaternion operator*(const Quaternion& a, const Quaternion& b) {
        return {a.scalar * b.scalar - dot(a.vector, b.vector),
                a.scalar * b.vector + b.scalar * a.vector + cross(a.vector, b.vector)};
    }
};

/// The matrix of a rotation, by rows.
struct RotationMatrix {
    std::array<Vector3<>, 3> rows;

    explicit RotationMatrix(const Quaternion& q) {
        const double w = q.scalar, x = q.vector.x, y = q.vector.y, z = q.vector.z;
        rows = {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                 {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                 {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
    }
    Vector3<> turned(const Vector3<>& v) const { return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)}; }
    Vector3<> turned_back(const Vector3<>& v) const { return v.x * rows[0] + v.y * rows[1] + v.z * rows[2]; }
};

/// A rotation as likely as any other, from three numbers evenly spread over (0, 1): K. Shoemake, in: D. Kirk
/// (ed.), Graphics Gems III (1992) 124.
Quaternion evenly_spread_rotation(const std::array<double, 3>& numbers);

/// Angular velocity [rad/s] of a body with this angular momentum, both in space; `inertia`: its principal
/// moments [kg m2], `axes` turns its principal axes into place.
Vector3<> angular_velocity(const Vector3<>& angular_momentum, const Vector3<>& inertia,
                           const RotationMatrix& axes);

/// The reverse [kg m2/s].
Vector3<> angular_momentum(const Vector3<>& angular_velocity, const Vector3<>& inertia,
                           const RotationMatrix& axes);

/// Where a body turns without torque in a time [s]: rotations about its principal axes one after the other
/// and back, each exact. The angular momentum in space is constant, the energy stays within an error of
/// second order that does not grow. A. Dullweber, B. Leimkuhler, R. McLachlan, J. Chem. Phys. 107 (1997)
/// 5840, section III.
Quaternion turned_freely(const Quaternion& orientation, const Vector3<>& angular_momentum,
                         const Vector3<>& inertia, double time);

}  // namespace talus::dem
