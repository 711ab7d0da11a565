#include "physics/dem/clumps/rotation.hpp"

#include <cmath>
#include <numbers>

namespace talus::dem {

Quaternion evenly_spread_rotation(const std::array<double, 3>& numbers) {
    const double u = numbers[0], a = 2 * std::numbers::pi * numbers[1], b = 2 * std::numbers::pi * numbers[2];
    const double inner = std::sqrt(1 - u), outer = std::sqrt(u);
    return {outer * std::cos(b), {inner * std::sin(a), inner * std::cos(a), outer * std::sin(b)}};
}

Vector3<> angular_velocity(const Vector3<>& angular_momentum, const Vector3<>& inertia,
                           const RotationMatrix& axes) {
    const Vector3<> along = axes.turned_back(angular_momentum);
    return axes.turned({along.x / inertia.x, along.y / inertia.y, along.z / inertia.z});
}

Vector3<> angular_momentum(const Vector3<>& angular_velocity, const Vector3<>& inertia,
                           const RotationMatrix& axes) {
    const Vector3<> along = axes.turned_back(angular_velocity);
    return axes.turned({along.x * inertia.x, along.y * inertia.y, along.z * inertia.z});
}

Quaternion turned_freely(const Quaternion& orientation, const Vector3<>& angular_momentum,
                         const Vector3<>& inertia, double time) {
    Quaternion q = orientation;
    Vector3<> momentum = RotationMatrix(q).turned_back(angular_momentum);  // along the principal axes
    const auto turn = [&](int axis, double duration) {
        const double along = axis == 0 ? momentum.x : axis == 1 ? momentum.y : momentum.z;
        const double moment = axis == 0 ? inertia.x : axis == 1 ? inertia.y : inertia.z;
        const double half_angle = 0.5 * duration * along / moment;
        const double s = std::sin(half_angle);
        const Quaternion about{std::cos(half_angle),
                               {axis == 0 ? s : 0.0, axis == 1 ? s : 0.0, axis == 2 ? s : 0.0}};
        q = q * about;
        momentum = RotationMatrix(about).turned_back(momentum);
    };
    turn(0, 0.5 * time);
    turn(1, 0.5 * time);
    turn(2, time);
    turn(1, 0.5 * time);
    turn(0, 0.5 * time);
    const double length = std::sqrt(q.scalar * q.scalar + dot(q.vector, q.vector));
    return {q.scalar / length, (1 / length) * q.vector};
}

}  // namespace talus::dem
