#include "physics/water/motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "domain/coupling_fields.hpp"
#include "domain/water_fields.hpp"
#include "physics/water/passes.hpp"

namespace talus::water {

namespace {

/// Writes the state `time` ahead into fields that may be those of the state itself.
void advance(ParticleSet& particles, double time, const Field<double>& to_velocity,
             const Field<double>& to_density) {
    const auto add = [&](const double* from, const double* rate, double* to) {
        for (std::size_t i = 0; i < particles.size(); ++i) to[i] = from[i] + time * rate[i];
    };
    for (int a = 0; a < particles.dimension(); ++a) {
        double* to = particles.data(to_velocity, a);
        add(particles.data(field::velocity, a), particles.data(field::acceleration, a), to);
        if (particles.has(coupling_field::grain_acceleration))
            add(to, particles.data(coupling_field::grain_acceleration, a), to);
    }
    add(particles.data(field::density), particles.data(water_field::density_rate),
        particles.data(to_density));
}

/// The least of some limits and whose it is.
struct Least {
    double value = std::numeric_limits<double>::infinity();
    std::size_t at = 0;
    void take(double limit, std::size_t i) {
        if (!(limit < value)) return;
        value = limit;
        at = i;
    }
};

}  // namespace

void kick(ParticleSet& particles, double time) { advance(particles, time, field::velocity, field::density); }

void predict(ParticleSet& particles, double time) {
    advance(particles, time, field::predicted_velocity, field::predicted_density);
}

sph::StepLimit stable_time_step(const ParticleSet& particles, const Settings& settings) {
    if (particles.size() == 0) return {std::numeric_limits<double>::infinity(), 0, "no particles"};
    constexpr double viscous_share = 0.125, accelerated_share = 0.25;
    const double h = settings.smoothing_length;
    const double *density = particles.data(field::predicted_density),
                 *rate = particles.data(water_field::density_rate),
                 *of_fluid = particles.data(density_of_fluid(particles));
    const double damping = 0.6 * settings.artificial_viscosity * settings.state.sound_speed;
    Least sound, acceleration;
    double least_share = 1;  // of the volume that the water fills
    for (std::size_t i = 0; i < particles.size(); ++i) {
        double a2 = 0;
        for (int d = 0; d < particles.dimension(); ++d) {
            const double a = particles.data(field::acceleration, d)[i];
            a2 += a * a;
        }
        const double speed =
            settings.state.sound_speed_at(of_fluid[i]) * std::sqrt(of_fluid[i] / density[i]) + damping +
            h * std::abs(rate[i]) / density[i];
        least_share = std::min(least_share, density[i] / of_fluid[i]);
        sound.take(settings.courant * h / speed, i);
        if (a2 > 0) acceleration.take(accelerated_share * std::sqrt(h / std::sqrt(a2)), i);
    }
    const std::uint64_t* id = particles.data(field::id);
    const double viscous = settings.viscosity > 0 ? viscous_share * h * h * settings.state.reference_density *
                                                        least_share / settings.viscosity
                                                  : std::numeric_limits<double>::infinity();
    if (viscous < sound.value && viscous < acceleration.value) return {viscous, id[0], "viscosity"};
    if (sound.value < acceleration.value) return {sound.value, id[sound.at], "sound"};
    return {acceleration.value, id[acceleration.at], "acceleration"};
}

}  // namespace talus::water
