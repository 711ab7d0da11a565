#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "tests/support/depth_run.hpp"

/// Water over rough terrain: a lake at rest stays at rest, whatever lies below it and wherever its shores
/// run.
namespace talus::test {
namespace {

/// Hills, of which one stands out of the water of level 0, and banks around.
double ground(double x, double y) {
    return 0.004 * (x * x + 1.3 * y * y) - 2 + 0.7 * std::sin(0.9 * x) * std::cos(0.7 * y) +
           2.5 * std::exp(-0.2 * ((x - 6) * (x - 6) + (y + 3) * (y + 3)));
}

std::shared_ptr<const Terrain> rough_terrain() {
    TerrainGrid grid{{-40, -40}, {0.8, 0.8}, 101, 101, {}};
    for (std::size_t row = 0; row < grid.rows; ++row)
        for (std::size_t column = 0; column < grid.columns; ++column)
            grid.elevations.push_back(ground(grid.origin[0] + 0.8 * static_cast<double>(column),
                                             grid.origin[1] + 0.8 * static_cast<double>(row)));
    return std::make_shared<const Terrain>(std::move(grid));
}

DepthScene lake(int dimension, double spacing) {
    DepthScene scene;
    scene.simulation.box.dimension = dimension;
    scene.simulation.terrain = rough_terrain();
    depth::Settings& settings = scene.simulation.settings;
    settings.balance = true;
    settings.eta = dimension == 1 ? 1.6 : 1.3;
    settings.largest_smoothing_length = 10;
    Release release;
    release.name = "lake";
    release.shape = BoxShape{{-35, -35, 0}, {35, 35, 0}};
    release.spacing = spacing;
    release.level = 0;
    scene.releases.push_back(release);
    scene.output.end_time = 20;
    return scene;
}

TEST(DepthLake, AtRestStaysAtRest) {
    const Communicator world(MPI_COMM_WORLD), alone(MPI_COMM_SELF);
    for (const int dimension : {1, 2}) {
        if (dimension % world.size() != world.rank() % 2) continue;
        const DepthResult flow = run_depth(alone, lake(dimension, dimension == 1 ? 0.25 : 1));
        fmt::print(
            "lake in {}D: {} particles, {} steps, greatest depth {:.3f} m, greatest speed {:.1e} m/s\n",
            dimension, flow.x.size(), flow.steps, flow.last.greatest_depth, flow.greatest_speed);
        EXPECT_EQ(flow.greatest_speed, 0);
        EXPECT_EQ(flow.last.centre, flow.first.centre);
        DepthScene plain = lake(dimension, dimension == 1 ? 0.25 : 1);
        plain.simulation.settings.balance = false;
        EXPECT_GT(run_depth(alone, plain).greatest_speed, 0.1) << "the bed is too smooth to tell";
    }
}

// The same of clear water where there may be solid.
TEST(DepthLake, OfTwoPhasesStaysAtRest) {
    const Communicator alone(MPI_COMM_SELF);
    for (const int dimension : {1, 2}) {
        DepthScene scene = lake(dimension, dimension == 1 ? 0.25 : 1);
        scene.simulation.settings.two_phase = depth::TwoPhase{};
        scene.simulation.settings.eta = dimension == 1 ? 2.4 : 2;
        scene.releases.front().solid_fraction = 0;
        scene.output.end_time = 5;
        const DepthResult flow = run_depth(alone, scene);
        EXPECT_EQ(flow.greatest_speed, 0);
        EXPECT_EQ(flow.last.centre, flow.first.centre);
        EXPECT_EQ(flow.last.water_volume, flow.first.volume);
    }
}

// Pushed, it swings, and what it swings with can only fall: the forces have a potential.
TEST(DepthLake, PushedGainsNoEnergy) {
    const Communicator world(MPI_COMM_WORLD), alone(MPI_COMM_SELF);
    for (const int dimension : {1, 2}) {
        if (dimension % world.size() != world.rank() % 2) continue;
        DepthScene scene = lake(dimension, dimension == 1 ? 0.25 : 1);
        scene.releases.front().velocity = {0.3, 0, 0};
        scene.output.end_time = 100;
        const DepthResult flow = run_depth(alone, scene);
        fmt::print("pushed lake in {}D: kinetic energy {:.3e} J, then {:.3e} J, gained in all {:.3e} J\n",
                   dimension, flow.first.kinetic_energy, flow.last.kinetic_energy,
                   flow.last.kinetic_energy + flow.last.potential_energy - flow.first.kinetic_energy -
                       flow.first.potential_energy);
        EXPECT_LT(flow.last.kinetic_energy + flow.last.potential_energy,
                  flow.first.kinetic_energy + flow.first.potential_energy);
        EXPECT_LT(flow.last.kinetic_energy, 0.2 * flow.first.kinetic_energy);
    }
}

}  // namespace
}  // namespace talus::test
