#include <cmath>

#include "domain/coupling_fields.hpp"
#include "domain/water_fields.hpp"
#include "physics/water/passes.hpp"

namespace talus::water {

namespace {

/// Of water: excess of the enthalpy over that of water at rest in even gravity, but for a constant, which is
/// the excess of density over that at rest to first order; and volume.
void prepare_water(ParticleSet& particles, const Settings& settings, double time) {
    const Tait& state = settings.state;
    const double rho0 = state.reference_density, c0 = state.sound_speed;
    const double *density = particles.data(field::density), *rate = particles.data(water_field::density_rate),
                 *mass = particles.data(field::mass);
    const double* solid = particles.has(coupling_field::solid_fraction)
                              ? particles.data(coupling_field::solid_fraction)
                              : nullptr;
    double* pressure = particles.data(field::pressure);
    float *volume = particles.data(water_field::partner_volume),
          *scaled = particles.data(water_field::partner_pressure),
          *excess = particles.data(water_field::partner_density);
    const int dimension = particles.dimension();
    std::array<const double*, 3> x{};
    std::array<double, 3> weight{};
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
        x[a] = particles.data(field::position, static_cast<int>(a));
        weight[a] = settings.bearing[a] / (c0 * c0);
    }
    if (dimension == 2) x[2] = x[1];  // weighs nothing
    const double size = std::pow(settings.radius(), dimension), unit = 1 / (rho0 * c0 * c0);
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const double ahead = density[i] + time * rate[i];
        const double of_water = solid ? ahead / share_of_water(solid[i]) : ahead;
        pressure[i] = state.pressure(of_water);
        volume[i] = static_cast<float>(mass[i] / (ahead * size));
        scaled[i] = static_cast<float>(unit * pressure[i]);
        excess[i] = static_cast<float>(state.enthalpy(of_water) - weight[0] * x[0][i] - weight[1] * x[1][i] -
                                       weight[2] * x[2][i]);
    }
    for (int a = 0; a < dimension; ++a) {
        const double *v = particles.data(field::velocity, a), *rates = particles.data(field::acceleration, a);
        float* to = particles.data(water_field::partner_velocity, a);
        const double* by_grains = particles.has(coupling_field::grain_acceleration)
                                      ? particles.data(coupling_field::grain_acceleration, a)
                                      : nullptr;
        for (std::size_t i = 0; i < particles.size(); ++i)
            to[i] = static_cast<float>((v[i] + time * (rates[i] + (by_grains ? by_grains[i] : 0.0))) / c0);
    }
}

/// Of walls: as if no water were near.
void prepare_walls(ParticleSet& particles, const Settings& settings, std::span<const sph::WallNow> walls) {
    const std::uint8_t* body = particles.data(field::body);
    float *volume = particles.data(water_field::partner_volume),
          *scaled = particles.data(water_field::partner_pressure),
          *sticks = particles.data(water_field::partner_density);
    double* pressure = particles.data(field::pressure);
    const int dimension = particles.dimension();
    std::array<const double*, 3> x{};
    std::array<float*, 3> v{};
    for (int a = 0; a < dimension; ++a) {
        x[static_cast<std::size_t>(a)] = particles.data(field::position, a);
        v[static_cast<std::size_t>(a)] = particles.data(water_field::partner_velocity, a);
    }
    const double unit = 1 / settings.state.sound_speed;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const sph::WallNow& wall = walls[body[i]];
        if (!wall.is_wall) continue;
        volume[i] = -volume[i];
        scaled[i] = 0;
        pressure[i] = 0;
        sticks[i] = wall.slips ? 0 : 1;
        if (wall.moves_freely) continue;
        const dem::Vector3<> moves =
            unit * wall.pose.velocity_at({x[0][i], x[1][i], dimension > 2 ? x[2][i] : 0.0});
        v[0][i] = static_cast<float>(moves.x);
        v[1][i] = static_cast<float>(moves.y);
        if (dimension > 2) v[2][i] = static_cast<float>(moves.z);
    }
}

}  // namespace

void prepare_partners(ParticleSet& particles, const Settings& settings, std::span<const sph::WallNow> walls,
                      double time) {
    prepare_water(particles, settings, time);
    if (!walls.empty()) prepare_walls(particles, settings, walls);
}

}  // namespace talus::water
