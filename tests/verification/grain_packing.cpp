#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "domain/random.hpp"
#include "tests/support/grain_scene.hpp"

/// Spheres that rain on a floor and come to rest: how dense they lie.
namespace talus::test {
namespace {

constexpr double width = 8, gravity = 1, least_radius = 0.47, greatest_radius = 0.53;  // mean diameter 1
constexpr double density = 6 / std::numbers::pi;                                       // about mass 1
constexpr std::size_t along = 6, layers = 26;

struct Bed {
    std::vector<std::array<double, 4>> spheres;  ///< x y z radius
    double weight_on_floor = 0;                  ///< over that of all grains
    double kinetic_energy = 0;                   ///< of a grain, over what lifts it by its diameter
    double greatest_overlap = 0;                 ///< over the smaller radius

    /// Of the layer between two heights; spheres by the exact volume of their parts within.
    double volume_fraction(double bottom, double top) const;
    double surface() const;  ///< height that 98 % of the centres are below
};

double Bed::volume_fraction(double bottom, double top) const {
    double filled = 0;
    for (const auto& [x, y, z, r] : spheres) {
        const auto below = [r = r, z = z](double height) {  // volume of the sphere below a height
            const double h = std::clamp(height - z + r, 0.0, 2 * r);
            return std::numbers::pi * h * h * (r - h / 3);
        };
        filled += below(top) - below(bottom);
    }
    return filled / (width * width * (top - bottom));
}

double Bed::surface() const {
    std::vector<double> heights;
    for (const auto& sphere : spheres) heights.push_back(sphere[2]);
    std::sort(heights.begin(), heights.end());
    return heights[heights.size() * 98 / 100];
}

Bed pour(double friction) {
    const Communicator world(MPI_COMM_WORLD);
    const RandomStream random{1, RandomPurpose::positions};
    std::vector<GrainState> grains;
    const double spacing = width / along;
    for (std::size_t k = 0; k < along * along * layers; ++k) {
        const auto place = [&](std::size_t cell, std::uint32_t counter) {
            return spacing * (static_cast<double>(cell) + 0.5 + 0.15 * (random.uniform(k, counter) - 0.5));
        };
        const double radius = least_radius + (greatest_radius - least_radius) * random.uniform(k, 3);
        grains.push_back(
            {{place(k % along, 0), place(k / along % along, 1), place(k / along / along, 2)},
             {random.uniform(k, 4) - 0.5, random.uniform(k, 5) - 0.5, random.uniform(k, 6) - 0.5},
             {},
             radius,
             density});
    }
    constexpr double stiffness = 4e4;  // the whole bed presses its lowest grains in by some 1e-3
    const double contact_time = std::numbers::pi / std::sqrt(2 * stiffness);
    GrainSetup setup{
        .box = {3, {}, {width, width, 0}, {Boundary::periodic, Boundary::periodic, Boundary::open}},
        .laws = linear_table({.name = "ball", .density = density, .restitution = 0.5, .friction = friction},
                             stiffness),
        .material = {0},
        .held = {0},
        .walls = {{"floor", 0, dem::PlaneShape{{}, {0, 0, 1}}, {}}},
        .gravity = {0, 0, -gravity},
        .time_step = contact_time / 15,
        .skin = 0.12};
    GrainSimulation run(world, setup, grain_set(world, grains));
    run.start();
    while (run.time() < 30) run.step();
    const GrainTotals totals = run.totals();
    std::vector<std::array<double, 4>> mine;
    for (std::size_t i = 0; i < run.grains().size(); ++i) {
        const auto x = [&](int axis) { return run.grains().data(field::position, axis)[i]; };
        mine.push_back({x(0), x(1), x(2), run.grains().data(field::radius)[i]});
    }
    return {world.all_gather(std::span<const std::array<double, 4>>(mine)),
            -totals.wall_forces[0][2] / (totals.mass * gravity),
            totals.kinetic_energy / static_cast<double>(totals.grains), totals.greatest_overlap};
}

/// Random close packing: 0.64 (G. D. Scott, Nature 188 (1960) 908, 0.637 and, poured loosely, 0.60; J. D.
/// Bernal, J. Mason, Nature 188 (1960) 910, 0.620 to 0.64; the maximally random jammed state, S. Torquato, T.
/// M. Truskett, P. G. Debenedetti, Phys. Rev. Lett. 84 (2000) 2064, 0.64). Radii that differ by 6 % keep the
/// floor from ordering the grains; they pack denser by less than 0.003. The bulk of 36 times 10 grains is a
/// sample of some 700, whose fraction scatters by 0.003 between halves of the bed.
TEST(GrainPacking, DenseWithoutFrictionLooseWithIt) {
    double found[2];
    for (const double friction : {0.0, 0.5}) {
        const Bed bed = pour(friction);
        EXPECT_NEAR(bed.weight_on_floor, 1, 0.02);
        EXPECT_LT(bed.kinetic_energy, 1e-3);
        EXPECT_LT(bed.greatest_overlap, 0.006);  // a bed denser by 3e-3 at its floor, at most
        found[friction > 0] = bed.volume_fraction(3, bed.surface() - 3);
    }
    EXPECT_NEAR(found[0], 0.64, 0.01);
    EXPECT_NEAR(found[1], 0.6, 0.015);
}

}  // namespace
}  // namespace talus::test
