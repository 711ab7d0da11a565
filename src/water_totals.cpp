#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "comm/exact_sum.hpp"
#include "domain/coupling_fields.hpp"
#include "src/water_simulation.hpp"

namespace talus {

WaterTotals WaterSimulation::totals() const {
    enum Sum { mass, kinetic, potential, elastic, px, py, pz, sum_count };
    enum Extreme { speed, density, pressure, place, extreme_count = place + 3 };
    std::vector<ExactSum> sums(sum_count);
    std::array<double, 2 * extreme_count> extremes;  // maxima; then minima with the sign changed
    extremes.fill(-std::numeric_limits<double>::infinity());
    std::uint64_t count = 0;
    const water::Settings& settings = setup_.settings;
    const double* solid = setup_.holds_grains ? particles_.data(coupling_field::solid_fraction) : nullptr;
    const auto take = [&extremes](int what, double value) {
        const auto k = static_cast<std::size_t>(what);
        extremes[k] = std::max(extremes[k], value);
        extremes[k + extreme_count] = std::max(extremes[k + extreme_count], -value);
    };
    for (std::size_t i = 0; i < particles_.size(); ++i) {
        if (!is_water(particles_.data(field::body)[i])) continue;
        ++count;
        const double m = particles_.data(field::mass)[i],
                     rho = particles_.data(field::density)[i] / water::share_of_water(solid ? solid[i] : 0.0);
        double speed2 = 0, height = 0;
        for (int a = 0; a < particles_.dimension(); ++a) {
            const double x = particles_.data(field::position, a)[i],
                         v = particles_.data(field::velocity, a)[i];
            sums[static_cast<std::size_t>(px + a)].add(m * v);
            speed2 += v * v;
            height -= settings.bearing[static_cast<std::size_t>(a)] * x;
            take(place + a, x);
        }
        sums[mass].add(m);
        sums[kinetic].add(0.5 * m * speed2);
        sums[potential].add(m * height);
        sums[elastic].add(m * settings.state.energy(rho));
        take(speed, std::sqrt(speed2));
        take(density, rho);
        take(pressure, settings.state.pressure(rho));
    }
    ExactSum::all_reduce(comm_, sums);
    comm_.all_max(std::span<double>(extremes));
    const auto least = [&](int what) { return -extremes[static_cast<std::size_t>(what + extreme_count)]; };
    const auto greatest = [&](int what) { return extremes[static_cast<std::size_t>(what)]; };
    WaterTotals totals{.mass = sums[mass].value(),
                       .kinetic_energy = sums[kinetic].value(),
                       .potential_energy = sums[potential].value(),
                       .elastic_energy = sums[elastic].value(),
                       .momentum = {sums[px].value(), sums[py].value(), sums[pz].value()},
                       .particles = comm_.all_sum(count)};
    if (totals.particles == 0) return totals;
    totals.greatest_speed = greatest(speed);
    totals.least_density = least(density);
    totals.greatest_density = greatest(density);
    totals.least_pressure = least(pressure);
    totals.greatest_pressure = greatest(pressure);
    for (int a = 0; a < particles_.dimension(); ++a) {
        totals.least_place[static_cast<std::size_t>(a)] = least(place + a);
        totals.greatest_place[static_cast<std::size_t>(a)] = greatest(place + a);
    }
    return totals;
}

}  // namespace talus
