#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "src/setup/water_scene.hpp"
#include "src/water/wall_loads.hpp"

namespace talus::test {
namespace {

/// Water between a floor and two walls that stick to it, of one material or another.
WaterScene tank(const Communicator& comm, const std::string& viscosity) {
    const std::string wall = "lattice = \"cubic\"\nwall = \"no_slip\"\nrecord_force = true\n";
    return read_water_scene(
        comm,
        Scene::parse("dimension = 2\n[water]\ngreatest_speed = 2\ngravity = [0, -10]\n" + viscosity + R"(
[[body]]
name = "water"
shape = "box"
lower = [0, 0]
upper = [1, 0.5]
lattice = "cubic"
spacing = 0.05
surface = 0.5
velocity = [0.3, 0.1]
[[body]]
name = "floor"
shape = "box"
lower = [-0.2, -0.2]
upper = [1.2, 0]
)" + wall + "[[body]]\nname = \"left\"\nshape = \"box\"\nlower = [-0.2, 0]\nupper = [0, 0.7]\n" +
                         wall +
                         "[[body]]\nname = \"right\"\nshape = \"box\"\nlower = [1, 0]\nupper = [1.2, 0.7]\n" +
                         wall + "[run]\nend_time = 1\n",
                     "tank.toml"));
}

class WallLoads : public testing::TestWithParam<const char*> {};

// What walls feel is what the water does not keep of its weight: forces of pairs, pair by pair, to single
// rounding (1e-6 a pair of a tenth of the weight, 200 particles).
TEST_P(WallLoads, BalanceTheMomentumOfTheWater) {
    const Communicator world(MPI_COMM_WORLD);
    const WaterScene scene = tank(world, GetParam());
    WaterSimulation run(world, scene.simulation, make_water(world, scene));
    run.start();
    for (int k = 0; k < 5; ++k) run.step();
    const ParticleSet& particles = run.particles();
    double mass = 0;
    dem::Vector3<> by_walls;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        if (particles.data(field::body)[i] != 0) continue;
        const double m = particles.data(field::mass)[i];
        mass += m;
        by_walls = by_walls + m * dem::Vector3<>{particles.data(field::acceleration, 0)[i],
                                                 particles.data(field::acceleration, 1)[i] + 10, 0};
    }
    dem::Vector3<> on_walls;
    for (const WallLoad& load : wall_loads(run)) on_walls = on_walls + load.force;
    const double weight = 10 * mass;
    EXPECT_NEAR(on_walls.x + by_walls.x, 0, 1e-5 * weight);
    EXPECT_NEAR(on_walls.y + by_walls.y, 0, 1e-5 * weight);
    EXPECT_LT(on_walls.y, -0.25 * weight);
    EXPECT_GT(on_walls.x, 0.01 * weight);
}

INSTANTIATE_TEST_SUITE_P(
    Viscosities, WallLoads,
    testing::Values("artificial_viscosity = 0.1", "viscosity = 5",
                    "[water.rheology]\nyield_stress = 50\nconsistency = 5\nexponent = 0.5"));

// Water at rest under its weight: rho g depth to what a compressibility of a per cent makes of it, also where
// half of the kernel is wall; its level to a hundredth of the spacing in the middle. Above it is dry.
TEST(Gauges, OfWaterAtRest) {
    const Communicator world(MPI_COMM_WORLD);
    const WaterScene scene = tank(world, "");
    const WaterSimulation run(world, scene.simulation, make_water(world, scene));
    const std::vector<WaterGauge> gauges{
        {"middle", {0.5, 0.2, 0}}, {"corner", {0, 0, 0}}, {"dry", {0.5, 0.8, 0}}};
    const std::vector<WaterReading> found = read_gauges(run, gauges);
    EXPECT_NEAR(found[0].pressure, 1000 * 10 * 0.3, 0.01 * 5000);
    EXPECT_NEAR(found[1].pressure, 1000 * 10 * 0.5, 0.01 * 5000);
    EXPECT_NEAR(found[0].level, 0.5, 0.01 * 0.05);
    EXPECT_NEAR(found[0].velocity[0], 0.3, 1e-12);
    EXPECT_NEAR(found[0].velocity[1], 0.1, 1e-12);
    EXPECT_EQ(found[2].pressure, 0);
    EXPECT_EQ(found[2].level, 0.8);
}

}  // namespace
}  // namespace talus::test
