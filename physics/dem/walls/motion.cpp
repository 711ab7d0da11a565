#include "physics/dem/walls/motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace talus::dem {

namespace {

struct Swing {
    double displacement, rate;  // of unit amplitude
};

Swing swing(const Oscillation& oscillation, double time) {
    const double omega = 2 * std::numbers::pi * oscillation.frequency,
                 angle = omega * time + oscillation.phase;
    return {std::sin(angle) - std::sin(oscillation.phase), omega * std::cos(angle)};
}

}  // namespace

WallPose WallMotion::pose(double time) const {
    const double elapsed = std::clamp(time, begin, end) - begin;
    const Swing shifting = swing(translation_oscillation, elapsed),
                turning = swing(rotation_oscillation, elapsed);
    WallPose pose;
    pose.centre = centre;
    pose.shift = elapsed * velocity + shifting.displacement * amplitude;
    const double angle = elapsed * angular_velocity + turning.displacement * angle_amplitude;
    if (angle != 0) {
        // O. Rodrigues, J. Math. Pures Appl. 5 (1840) 380.
        const double c = std::cos(angle), s = std::sin(angle);
        const Vector3<>& u = axis;
        pose.rows = {
            Vector3<>{c + (1 - c) * u.x * u.x, (1 - c) * u.x * u.y - s * u.z, (1 - c) * u.x * u.z + s * u.y},
            Vector3<>{(1 - c) * u.y * u.x + s * u.z, c + (1 - c) * u.y * u.y, (1 - c) * u.y * u.z - s * u.x},
            Vector3<>{(1 - c) * u.z * u.x - s * u.y, (1 - c) * u.z * u.y + s * u.x, c + (1 - c) * u.z * u.z}};
    }
    if (time >= begin && time < end) {
        pose.velocity = velocity + shifting.rate * amplitude;
        pose.angular_velocity = (angular_velocity + turning.rate * angle_amplitude) * axis;
    }
    return pose;
}

}  // namespace talus::dem
