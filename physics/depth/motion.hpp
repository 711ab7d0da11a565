#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "domain/particles.hpp"
#include "physics/depth/basal_friction.hpp"
#include "physics/depth/settings.hpp"
#include "physics/sph/motion.hpp"

/// Leapfrog, kick-drift-kick. A particle moves in plan; where the form is fitted to the bed, it moves on the
/// surface z(x, y) as a point under constraint does, and its speed is that along the surface.
namespace talus::depth {

/// The surface's direction at a place; level by default.
struct Tilt {
    double cosine2 = 1, cosine = 1;  ///< of the angle between its normal and the vertical [1]

    Tilt() = default;
    template <std::size_t D>
    explicit Tilt(const std::array<double, D>& slope) {
        double steepness2 = 0;
        for (const double s : slope) steepness2 += s * s;
        cosine2 = 1 / (1 + steepness2);
        cosine = std::sqrt(cosine2);
    }
};

/// Gravity along the normal of the bed, with the pull of its curvature if that counts: a flow does not press
/// on a bed that it leaves [m/s2].
inline double normal_gravity(const Settings& settings, double apparent, double cosine) {
    return cosine * (settings.curvature ? std::max(apparent, 0.0) : settings.gravity);
}

/// Moves velocities `time` forward: by the acceleration, then by the bed's friction, which cannot reverse
/// them and holds what it can hold.
void kick(ParticleSet& particles, const Settings& settings, const BasalFriction& friction, double time);
/// The same into predicted_velocity.
void predict(ParticleSet& particles, const Settings& settings, const BasalFriction& friction, double time);

/// Positions: x += v time. With entrainment a particle takes up volume on its way s, V = V_0 exp(E_s s), and
/// its momentum is shared by it: the way is then ln(1 + E_s v time)/E_s, without error for any time. O.
/// Hungr, Can. Geotech. J. 32 (1995) 610. Two phases take nothing up here (erosion_pass()).
void drift(ParticleSet& particles, const Settings& settings, double time);

/// Lets still_acceleration fade along the way, by the factor e in a smoothing length: it belongs to the
/// columns as they lay over the bed at the start.
void fade_balance(ParticleSet& particles, double time);

/// Longest stable step over the own particles: dt = C s / (signal speed), dt = C sqrt(s/|a|), and dt = C
/// L/|v| with the length L over which the bed may change, infinite for a plane [m]: no particle jumps over a
/// ridge or a hole.
sph::StepLimit stable_time_step(const ParticleSet& particles, const Settings& settings, double bed_length);

}  // namespace talus::depth
