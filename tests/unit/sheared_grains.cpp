#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "physics/dem/shear.hpp"
#include "src/flow/region_statistics.hpp"
#include "tests/support/grain_scene.hpp"

namespace talus::test {
namespace {

constexpr double edge = 0.1, rate = 50;

GrainSetup sheared_setup() {
    GrainSetup setup = grain_setup({{.name = "glass",
                                     .density = 2500,
                                     .youngs_modulus = 1e7,
                                     .poisson_ratio = 0.2,
                                     .restitution = 0.7,
                                     .friction = 0.5}},
                                   0.004, 1e-5);
    setup.box = {
        3, {}, {edge, edge, edge}, {Boundary::periodic, Boundary::periodic, Boundary::periodic}, rate};
    return setup;
}

/// Place and velocity of grain `second` as grain `first` sees it.
struct Relative {
    dem::Vector3<> position, velocity;
};
Relative relative(const GrainSimulation& run, std::uint64_t first, std::uint64_t second) {
    const double offset = std::fmod(rate * edge * run.time(), edge);
    GrainState a = state_of(run, first), b = state_of(run, second);
    for (GrainState* grain : {&a, &b}) {
        const double turns = std::floor(grain->position.y / edge);
        grain->position.x -= turns * offset;
        grain->position.y -= turns * edge;
    }
    Relative seen{b.position - a.position, b.velocity - a.velocity};
    const double turns = std::round(seen.position.y / edge);
    seen.position.x = std::remainder(seen.position.x - turns * offset, edge);
    seen.position.y -= turns * edge;
    seen.velocity.x -= turns * rate * edge;
    return seen;
}

// Nothing tells a collision in the middle of the box from one whose grains cross the border meanwhile.
TEST(ShearedGrains, CollideAcrossTheBorderAsInTheMiddle) {
    const Communicator comm(MPI_COMM_SELF);
    const GrainSetup setup = sheared_setup();
    std::vector<GrainState> grains;
    for (const double up : {0.0, 0.0525}) {
        GrainState lower{{0.03, 0.0455 + up, 0.05}, {0.5, 0.6, 0}, {10, 0, 30}, 0.004, 2500};
        GrainState upper{{0.0375, 0.0485 + up, 0.0502}, {-0.5, 0.3, 0.1}, {0, 20, 0}, 0.004, 2500};
        for (GrainState grain : {lower, upper}) {
            // Beyond the upper side is the box that moves faster: the velocity of the image within is given.
            grain.velocity.x += dem::shear_flow(setup.box, grain.position.y);
            grains.push_back(grain);
        }
    }
    GrainSimulation run(comm, setup, grain_set(comm, grains));
    run.start();
    bool touched = false;
    for (int k = 0; k < 500; ++k) {
        run.step();
        touched = touched || run.totals().contacts == 2;
        const Relative middle = relative(run, 0, 1), border = relative(run, 2, 3);
        ASSERT_LT(norm(middle.position - border.position), 1e-12) << "step " << k;
        ASSERT_LT(norm(middle.velocity - border.velocity), 1e-8) << "step " << k;
    }
    EXPECT_TRUE(touched);
    EXPECT_GT(norm(state_of(run, 1).angular_velocity - dem::Vector3<>{0, 20, 0}), 5) << "no friction";
    EXPECT_LT(norm(state_of(run, 1).angular_velocity - state_of(run, 3).angular_velocity), 1e-6);
}

// The same of dumbbells that tumble: while they cross, their spheres are on both sides of the border, and the
// velocity of a clump changes where its centre crosses, that of a sphere's image where the sphere does.
TEST(ShearedGrains, ClumpsCollideAcrossTheBorderAsInTheMiddle) {
    const Communicator comm(MPI_COMM_SELF);
    GrainSetup setup = sheared_setup();
    const std::vector<dem::Vector3<>> centres{{-0.004, 0, 0}, {0.004, 0, 0}};
    const dem::ClumpShape shape = dem::clump_shape(centres, std::vector{0.004, 0.004});
    setup.clumps = {{std::make_shared<const dem::ClumpShape>(shape), 0, 2500}};
    const dem::ClumpBody& body = setup.clumps[0];
    const double s = std::sin(0.6), c = std::cos(0.6);
    std::vector<dem::ClumpState> clumps;
    for (const double up : {0.0, 0.045})
        for (const dem::ClumpState& state :
             {dem::moving_clump(body, {0.03, 0.0425 + up, 0.05}, {c, {0, 0, s}}, {0.5, 2.6, 0}, {10, 0, 60}),
              dem::moving_clump(body, {0.039, 0.0505 + up, 0.0502}, {c, {s, 0, 0}}, {-0.5, 1.8, 0.1},
                                {0, 20, -90})}) {
            clumps.push_back(state);
            clumps.back().velocity.x += dem::shear_flow(setup.box, state.centre.y);
        }
    GrainSimulation run(comm, setup, clump_set(comm, setup, clumps));
    run.start();
    std::uint64_t most = 0;
    const auto momentum = [&](std::uint64_t sphere) { return clump_of(run, sphere).angular_momentum; };
    const dem::Vector3<> before = momentum(2);
    std::set<double> borders;  // whole lengths between the spheres of a clump as stored
    for (int k = 0; k < 1200; ++k) {
        run.step();
        most = std::max(most, run.totals().contacts);
        for (const auto& [a, b] : {std::pair{0, 1}, {0, 2}, {0, 3}, {2, 3}}) {
            const Relative middle = relative(run, a, b), border = relative(run, a + 4, b + 4);
            ASSERT_LT(norm(middle.position - border.position), 1e-12) << "step " << k;
            ASSERT_LT(norm(middle.velocity - border.velocity), 1e-8) << "step " << k;
        }
        borders.insert(std::round((state_of(run, 4).position.y - state_of(run, 5).position.y) / edge));
        borders.insert(std::round((state_of(run, 6).position.y - state_of(run, 7).position.y) / edge));
    }
    EXPECT_GE(most, 2U);
    EXPECT_GT(borders.size(), 1U) << "no clump reached through the border";
    EXPECT_GT(norm(momentum(2) - before), 0.1 * norm(before)) << "no collision";
    EXPECT_LT(norm(momentum(2) - momentum(6)), 1e-9 * norm(before));
}

// What is asked of a state must not depend on when lists were made either: contacts across the border and the
// stress of the whole box, to the bit.
TEST(ShearedGrains, StressDoesNotDependOnLists) {
    const Communicator comm(MPI_COMM_SELF);
    std::vector<GrainState> grains;
    for (int k = 0; k < 343; ++k) {
        const dem::Vector3<> place{0.014 * (k % 7) + 0.005, 0.014 * (k / 7 % 7) + 0.005,
                                   0.014 * (k / 49) + 0.005};
        grains.push_back(
            {place, {0.8 * std::sin(3.0 * k), 0.8 * std::cos(5.0 * k), 0.5 * std::sin(k)}, {}, 0.0065, 2500});
    }
    std::vector<std::array<double, 6>> stresses;
    for (const double skin : {0.0002, 0.002}) {
        GrainSetup setup = sheared_setup();
        setup.skin = skin;
        GrainSimulation run(comm, setup, grain_set(comm, grains));
        run.start();
        for (int k = 0; k < 150; ++k) run.step();
        const std::vector<dem::LoadedContact> contacts = run.loaded_contacts();
        EXPECT_GT(contacts.size(), 50U);
        const std::vector<WatchedRegion> all{{"all", BoxShape{{0, 0, 0}, {edge, edge, edge}}, true}};
        stresses.push_back(
            region_states(comm, run.grains(), run.setup().box, run.clumps(), 1, all, contacts)[0].stress);
    }
    EXPECT_NE(stresses[0][3], 0);
    EXPECT_EQ(stresses[0], stresses[1]);
}

// A grain that nothing touches comes through the upper side four times, each time slower by the images'
// velocity.
TEST(ShearedGrains, SlowDownWhereTheyComeBackIn) {
    const Communicator comm(MPI_COMM_SELF);
    GrainSetup setup = sheared_setup();
    setup.time_step = 1e-4;
    GrainState grain{{0.03, 0.07, 0.05}, {dem::shear_flow(setup.box, 0.07), 2, 0}, {}, 0.004, 2500};
    GrainSimulation run(comm, setup, grain_set(comm, {grain}));
    run.start();
    for (int k = 0; k < 2000; ++k) run.step();  // 0.4 m up
    EXPECT_NEAR(state_of(run, 0).velocity.x, dem::shear_flow(setup.box, 0.07) - 4 * rate * edge, 1e-9);
    EXPECT_NEAR(run.totals().momentum[1], 2 * mass_of(grain), 1e-12);
}

}  // namespace
}  // namespace talus::test
