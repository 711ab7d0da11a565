#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "comm/exact_sum.hpp"
#include "domain/depth_fields.hpp"
#include "domain/two_phase_fields.hpp"
#include "src/depth_simulation.hpp"

namespace talus {

double DepthSimulation::density(std::size_t i) const {
    const depth::Settings& settings = setup_.settings;
    if (!settings.two_phase) return settings.density;
    return settings.two_phase->density(particles_.data(field::is_water)[i] != 0);
}

double DepthSimulation::whole_depth(std::size_t i) const {
    const double own = particles_.data(field::depth)[i];
    if (!setup_.settings.two_phase) return own;
    // In proportion of the heights of the same moment; 0 before the first evaluation.
    const double height = particles_.data(field::column_height)[i];
    return height > 0 ? own * (1 + particles_.data(field::other_height)[i] / height) : own;
}

DepthTotals DepthSimulation::totals() const {
    enum Sum { volume, kinetic, potential, px, py, mx, my, stopped, water, wx, wy, sum_count };
    std::vector<ExactSum> sums(sum_count);
    std::array<double, 6> extremes;  // x, y, -x, -y, speed, depth
    extremes.fill(-std::numeric_limits<double>::infinity());
    const depth::Settings& settings = setup_.settings;
    const bool fitted = settings.form == depth::Form::bed_fitted;
    const auto dimension = static_cast<std::size_t>(particles_.dimension());
    for (std::size_t i = 0; i < particles_.size(); ++i) {
        std::array<double, 2> x{}, v{};
        for (std::size_t a = 0; a < dimension; ++a) {
            x[a] = particles_.data(field::position, static_cast<int>(a))[i];
            v[a] = particles_.data(field::velocity, static_cast<int>(a))[i];
        }
        const TerrainPoint ground = setup_.terrain->at(x[0], x[1]);
        const double climb = fitted ? ground.slope[0] * v[0] + ground.slope[1] * v[1] : 0;
        const double speed2 = v[0] * v[0] + v[1] * v[1] + climb * climb;
        const double cosine = fitted ? depth::Tilt(ground.slope).cosine : 1;
        const double own = particles_.data(field::volume)[i], mass = density(i) * own, h = whole_depth(i);
        sums[volume].add(own);
        sums[kinetic].add(0.5 * mass * speed2);
        sums[potential].add(mass * settings.gravity * (ground.elevation + 0.5 * h * cosine));
        sums[px].add(mass * v[0]);
        sums[py].add(mass * v[1]);
        sums[mx].add(own * x[0]);
        sums[my].add(own * x[1]);
        if (speed2 == 0) sums[stopped].add(own);
        if (settings.two_phase && particles_.data(field::is_water)[i] != 0) {
            sums[water].add(own);
            sums[wx].add(own * x[0]);
            sums[wy].add(own * x[1]);
        }
        extremes = {std::max(extremes[0], x[0]),
                    std::max(extremes[1], x[1]),
                    std::max(extremes[2], -x[0]),
                    std::max(extremes[3], -x[1]),
                    std::max(extremes[4], std::sqrt(speed2)),
                    std::max(extremes[5], h)};
    }
    ExactSum::all_reduce(comm_, sums);
    comm_.all_max(std::span<double>(extremes));
    if (total_particles() == 0) return {};
    const double all = sums[volume].value(), of_water = sums[water].value();
    const auto mean = [of_water](const ExactSum& sum) { return of_water > 0 ? sum.value() / of_water : 0; };
    return {.volume = all,
            .kinetic_energy = sums[kinetic].value(),
            .potential_energy = sums[potential].value(),
            .momentum = {sums[px].value(), sums[py].value()},
            .centre = {sums[mx].value() / all, sums[my].value() / all},
            .least_place = {-extremes[2], -extremes[3]},
            .greatest_place = {extremes[0], extremes[1]},
            .greatest_speed = extremes[4],
            .greatest_depth = extremes[5],
            .stopped = sums[stopped].value() / all,
            .water_volume = of_water,
            .water_centre = {mean(sums[wx]), mean(sums[wy])}};
}

}  // namespace talus
