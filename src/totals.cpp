#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "comm/exact_sum.hpp"
#include "src/simulation.hpp"

namespace talus {

Totals Simulation::totals() const {
    enum Sum {
        mass,
        kinetic,
        internal,
        px,
        py,
        pz,
        lx,
        ly,
        lz,
        damage_sum,
        potential,
        gx,
        gy,
        gz,
        gravity_size,
        sum_count
    };
    std::vector<ExactSum> sums(sum_count);
    std::array<double, 5> extremes{};  // maxima; minima with their sign changed
    extremes.fill(-std::numeric_limits<double>::infinity());
    const int dimension = particles_.dimension();
    const double* m = particles_.data(field::mass);
    const double* u = particles_.data(field::internal_energy);
    const double* density = particles_.data(field::predicted_density);
    const double* pressure = particles_.data(field::pressure);
    const double* damage = particles_.has(field::damage) ? particles_.data(field::damage) : nullptr;
    const double* phi = gravity_ ? particles_.data(field::gravity_potential) : nullptr;
    for (std::size_t i = 0; i < particles_.size(); ++i) {
        std::array<double, 3> x{}, p{};
        double speed2 = 0;
        for (int a = 0; a < dimension; ++a) {
            const double v = particles_.data(field::velocity, a)[i];
            x[static_cast<std::size_t>(a)] = particles_.data(field::position, a)[i];
            p[static_cast<std::size_t>(a)] = m[i] * v;
            speed2 += v * v;
        }
        sums[mass].add(m[i]);
        sums[kinetic].add(0.5 * m[i] * speed2);
        sums[internal].add(m[i] * u[i]);
        sums[px].add(p[0]);
        sums[py].add(p[1]);
        sums[pz].add(p[2]);
        sums[lx].add(x[1] * p[2] - x[2] * p[1]);
        sums[ly].add(x[2] * p[0] - x[0] * p[2]);
        sums[lz].add(x[0] * p[1] - x[1] * p[0]);
        if (damage) sums[damage_sum].add(m[i] * damage[i]);
        if (setup_.even_gravity && !is_wall(particles_.data(field::body)[i])) {
            const std::array<double, 3>& g = *setup_.even_gravity;
            sums[potential].add(-m[i] * (g[0] * x[0] + g[1] * x[1] + g[2] * x[2]));
        }
        if (phi) {
            sums[potential].add(0.5 * m[i] * phi[i]);
            double size2 = 0;
            for (int a = 0; a < dimension; ++a) {
                const double force = m[i] * particles_.data(field::gravity_acceleration, a)[i];
                sums[static_cast<std::size_t>(gx + a)].add(force);
                size2 += force * force;
            }
            sums[gravity_size].add(std::sqrt(size2));
        }
        extremes = {std::max(extremes[0], std::sqrt(speed2)), std::max(extremes[1], -density[i]),
                    std::max(extremes[2], density[i]), std::max(extremes[3], -pressure[i]),
                    std::max(extremes[4], pressure[i])};
    }
    ExactSum::all_reduce(comm_, sums);
    comm_.all_max(std::span<double>(extremes));
    const double total_mass = sums[mass].value(), gravity = sums[gravity_size].value();
    return {.mass = total_mass,
            .kinetic_energy = sums[kinetic].value(),
            .internal_energy = sums[internal].value(),
            .momentum = {sums[px].value(), sums[py].value(), sums[pz].value()},
            .angular_momentum = {sums[lx].value(), sums[ly].value(), sums[lz].value()},
            .greatest_speed = extremes[0],
            .least_density = -extremes[1],
            .greatest_density = extremes[2],
            .least_pressure = -extremes[3],
            .greatest_pressure = extremes[4],
            .mean_damage = sums[damage_sum].value() / total_mass,
            .particles = total_particles(),
            .potential_energy = sums[potential].value(),
            .gravity_drift =
                gravity > 0 ? std::hypot(sums[gx].value(), sums[gy].value(), sums[gz].value()) / gravity : 0};
}

}  // namespace talus
