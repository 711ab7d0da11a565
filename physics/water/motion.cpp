#include "physics/water/motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "domain/coupling_fields.hpp"
#include "domain/water_fields.hpp"

namespace talus::water {

namespace {

void move_on(ParticleSet& particles, const Field<double>& what, const Field<double>& rate, double time) {
    const int components = component_count(what.shape, particles.dimension());
    for (int c = 0; c < components; ++c) {
        double* to = particles.data(what, c);
        const double* by = particles.data(rate, c);
        for (std::size_t i = 0; i < particles.size(); ++i) to[i] += time * by[i];
    }
}

/// The greatest of some values and whose it is.
struct Greatest {
    double value = 0;
    std::size_t at = 0;
    void take(double other, std::size_t i) {
        if (!(other > value)) return;
        value = other;
        at = i;
    }
};

}  // namespace

void kick(ParticleSet& particles, double time) {
    move_on(particles, field::velocity, field::acceleration, time);
    if (particles.has(coupling_field::grain_acceleration))
        move_on(particles, field::velocity, coupling_field::grain_acceleration, time);
    move_on(particles, field::density, water_field::density_rate, time);
}

void shift(ParticleSet& particles, double time) {
    if (particles.has(water_field::shift_velocity))
        move_on(particles, field::position, water_field::shift_velocity, time);
}

sph::StepLimit stable_time_step(const ParticleSet& particles, const Settings& settings) {
    const double infinity = std::numeric_limits<double>::infinity();
    if (particles.size() == 0) return {infinity, 0, "no particles"};
    constexpr double accelerated_share = 0.25;
    const double h = settings.smoothing_length;
    const double *density = particles.data(field::density), *rate = particles.data(water_field::density_rate);
    const int dimension = particles.dimension();
    std::array<const double*, 3> a{};
    for (int d = 0; d < 3; ++d)
        a[static_cast<std::size_t>(d)] = particles.data(field::acceleration, std::min(d, dimension - 1));
    Greatest speed, acceleration2;
    const double* solid = particles.has(coupling_field::solid_fraction)
                              ? particles.data(coupling_field::solid_fraction)
                              : nullptr;
    const std::uint64_t* id = particles.data(field::id);
    double least_share = 1;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        if (!(density[i] > 0)) return {0, id[i], "a density that is not positive"};
        const double in_plane = a[0][i] * a[0][i] + a[1][i] * a[1][i];
        acceleration2.take(dimension == 2 ? in_plane : in_plane + a[2][i] * a[2][i], i);
        // Of one particle: the greatest of each over a rank would depend on who owns what.
        const double share = solid ? share_of_water(solid[i]) : 1;
        speed.take(settings.state.sound_speed_at(density[i] / share) / std::sqrt(share) +
                       h * std::abs(rate[i]) / density[i],
                   i);
        least_share = std::min(least_share, share);
    }
    const double damping = 0.6 * settings.artificial_viscosity * settings.state.sound_speed,
                 sound = settings.courant * h / (speed.value + damping),
                 accelerated = acceleration2.value > 0
                                   ? accelerated_share * std::sqrt(h / std::sqrt(acceleration2.value))
                                   : infinity,
                 viscous = least_share * settings.viscous_time_step();
    if (viscous < sound && viscous < accelerated) return {viscous, id[speed.at], "viscosity"};
    if (sound < accelerated) return {sound, id[speed.at], "sound"};
    return {accelerated, id[acceleration2.at], "acceleration"};
}

}  // namespace talus::water
