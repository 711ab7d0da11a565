#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "domain/clump_fields.hpp"
#include "domain/grain_fields.hpp"
#include "src/flow/region_statistics.hpp"
#include "tests/support/grain_scene.hpp"

/// Clumps of spheres under the whole step.
namespace talus::test {
namespace {

using dem::Vector3;

const dem::GrainMaterial hard{
    .name = "hard", .density = 2500, .youngs_modulus = 1e9, .poisson_ratio = 0.25, .restitution = 1};

constexpr double radius = 0.005;

/// Two spheres that overlap by a third of their radius.
GrainSetup dumbbells(dem::GrainMaterial material, double time_step) {
    GrainSetup setup = grain_setup({material}, radius, time_step);
    const std::vector<Vector3<>> centres{{-0.004, 0, 0}, {0.004, 0, 0}};
    setup.clumps = {
        {std::make_shared<dem::ClumpShape>(dem::clump_shape(centres, std::vector{radius, radius})), 0,
         material.density}};
    return setup;
}

// A dumbbell meets a smooth floor with one end: the impulse is 2 v/(1/M + (r x n) I^-1 (r x n)) for rigid
// bodies and e = 1 (E. J. Routh, Dynamics of a System of Rigid Bodies, art. 168). Soft spheres touch for a
// while and turn meanwhile, by 3e-3 here: that is the tolerance.
TEST(Clumps, ADumbbellBouncesOffAFloor) {
    const Communicator comm(MPI_COMM_SELF);
    GrainSetup setup = dumbbells(hard, 2e-7);
    setup.walls.push_back({"floor", 0, dem::PlaneShape{{}, {0, 0, 1}}, {}});
    const double tilt = 0.6, speed = 0.1;
    const dem::ClumpState state{{0, 0, 0.004 * std::sin(tilt) + radius + 1e-6},
                                {0, 0, -speed},
                                {std::cos(tilt / 2), {0, -std::sin(tilt / 2), 0}},
                                {}};
    GrainSimulation run(comm, setup, clump_set(comm, setup, {state}));
    run.start();
    const double before = run.totals().kinetic_energy;
    for (bool touched = false; run.totals().wall_contacts > 0 || !touched; run.step())
        touched = touched || run.totals().wall_contacts > 0;
    const dem::ClumpBody& body = setup.clumps[0];
    const double arm = 0.004 * std::cos(tilt), moment = body.inertia().z;
    const double impulse = 2 * speed / (1 / body.mass() + arm * arm / moment);
    const GrainTotals after = run.totals();
    const double expected = impulse / body.mass() - speed, spin = impulse * arm / moment;
    EXPECT_NEAR(after.momentum[2] / body.mass(), expected, 3e-3 * speed);
    EXPECT_NEAR(after.rotational_energy, 0.5 * moment * spin * spin, 6e-3 * before);
    EXPECT_NEAR(after.kinetic_energy + after.rotational_energy, before, 1e-4 * before);
    EXPECT_NEAR(after.mass, body.mass(), 1e-15);
}

// A clump of one sphere is a sphere.
TEST(Clumps, OfOneSphereMovesAsASphere) {
    const Communicator comm(MPI_COMM_SELF);
    dem::GrainMaterial rough = hard;
    rough.friction = 0.4;
    rough.restitution = 0.6;
    GrainSetup setup = grain_setup({rough}, radius, 1e-6);
    setup.gravity = {0, 0, -9.81};
    setup.walls.push_back({"floor", 0, dem::PlaneShape{{}, {0, 0, 1}}, {}});
    GrainSimulation sphere(comm, setup,
                           grain_set(comm, {{{0, 0, 0.0055}, {0.3, 0.1, -0.2}, {}, radius, 2500}}));
    const std::vector<Vector3<>> centre{{0, 0, 0}};
    setup.clumps = {
        {std::make_shared<dem::ClumpShape>(dem::clump_shape(centre, std::vector{radius})), 0, rough.density}};
    const dem::ClumpState state{{0, 0, 0.0055}, {0.3, 0.1, -0.2}, {}, {}};
    GrainSimulation clump(comm, setup, clump_set(comm, setup, {state}));
    for (GrainSimulation* run : {&sphere, &clump}) {
        run->start();
        for (int k = 0; k < 30000; ++k) run->step();
    }
    const GrainState a = state_of(sphere, 0), b = state_of(clump, 0);
    EXPECT_GT(norm(a.angular_velocity), 5);
    EXPECT_LT(norm(a.position - b.position), 1e-9);
    EXPECT_LT(norm(a.angular_velocity - b.angular_velocity), 1e-6);
}

// Elastic and smooth dumbbells in a cloud of their own, nothing else: energy, momentum and angular momentum
// stay, and so do the distances within each.
TEST(Clumps, ACloudKeepsWhatIsConserved) {
    const Communicator comm(MPI_COMM_SELF);
    const GrainSetup setup = dumbbells(hard, 1e-6);
    std::vector<dem::ClumpState> states;
    for (int k = 0; k < 27; ++k) {
        const Vector3<> centre{0.019 * (k % 3), 0.019 * (k / 3 % 3), 0.019 * (k / 9)};
        const double half = 0.5 * k;
        states.push_back(
            {centre,
             -20 * (centre - Vector3<>{0.019, 0.019, 0.019}) + Vector3<>{0, 0.1 * std::sin(k), 0},
             {std::cos(half), {0.6 * std::sin(half), 0, 0.8 * std::sin(half)}},
             {0, 1e-6 * std::cos(k), 0}});
    }
    GrainSimulation run(comm, setup, clump_set(comm, setup, states));
    const auto angular = [&] {
        Vector3<> sum;
        for (std::size_t i = 0; i < run.grains().size(); ++i) {
            if (run.grains().data(field::id)[i] % 2 > 0) continue;
            const dem::ClumpState s = dem::clump_state(run.grains(), i);
            sum += s.angular_momentum + setup.clumps[0].mass() * cross(s.centre, s.velocity);
        }
        return sum;
    };
    run.start();
    const GrainTotals before = run.totals();
    const Vector3<> turning = angular();
    std::uint64_t most_contacts = 0;
    for (int k = 0; k < 40000; ++k) {
        run.step();
        if (k % 100 == 0) most_contacts = std::max(most_contacts, run.totals().contacts);
    }
    const GrainTotals after = run.totals();
    EXPECT_GT(most_contacts, 0U);
    EXPECT_GT(run.evaluated_contacts(), 1000U);
    EXPECT_EQ(after.contacts, 0U) << "the energy of contacts is not counted";
    const double energy = before.kinetic_energy + before.rotational_energy;
    EXPECT_GT(std::abs(after.rotational_energy - before.rotational_energy), 0.05 * energy);
    EXPECT_NEAR(after.kinetic_energy + after.rotational_energy, energy, 2e-3 * energy);
    const double scale = before.mass * before.greatest_speed;
    for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(after.momentum[a], before.momentum[a], 1e-13 * scale);
    EXPECT_LT(norm(angular() - turning), 1e-12 * scale * 0.05);
    for (std::uint64_t k = 0; k < 27; ++k)
        EXPECT_NEAR(norm(state_of(run, 2 * k).position - state_of(run, 2 * k + 1).position), 0.008, 1e-15);
}

// A periodic box is filled at once with dumbbells at rest that reach through its sides: none overlap.
TEST(Clumps, ASourceFindsWhatIsAcrossTheSides) {
    const Communicator comm(MPI_COMM_SELF);
    constexpr double length = 0.05;
    GrainSetup setup = dumbbells(hard, 1e-6);
    const std::vector<Vector3<>> ends{{-0.012, 0, 0}, {0.012, 0, 0}};
    setup.clumps[0].shape =
        std::make_shared<dem::ClumpShape>(dem::clump_shape(ends, std::vector{radius, radius}));
    setup.box = {
        3, {0, 0, 0}, {length, length, length}, {Boundary::periodic, Boundary::periodic, Boundary::periodic}};
    GrainSource rain{.name = "rain",
                     .body = 0,
                     .density = hard.density,
                     .region = BoxShape{{0, 0, 0}, {length, length, length}},
                     .clump = setup.clumps[0].shape,
                     .turned = true,
                     .rate = 1e9,
                     .total = 100};
    rain.tries = 100;
    setup.flow = {{}, {rain}, 5};
    GrainSimulation run(comm, setup, clump_set(comm, setup, {}));
    run.start();
    for (int k = 0; k < 3; ++k) run.step();
    const GrainTotals totals = run.totals();
    EXPECT_GT(run.flow().came()[0].count, 30U);
    EXPECT_EQ(totals.contacts, 0U);
    EXPECT_EQ(totals.kinetic_energy, 0);
}

// Dumbbells rain into a box that is periodic along x and y and settle on its floor. Forces balance to
// `imbalance`; ten times that is asked of the floor's load, and of the stress 1e-3, for overlaps of that
// share of a radius. Of clumps at rest the mean stress times the volume is sum m g z along z: -sum r f, r
// from their centres, is sum m g z less the moment of the floor's forces, whose contacts lie half an overlap
// below z = 0. A smooth floor bears no moment across.
TEST(Clumps, ABedBearsItsWeight) {
    const Communicator comm(MPI_COMM_SELF);
    dem::GrainMaterial rough = hard;
    rough.youngs_modulus = 1e7;
    rough.restitution = 0.3;
    rough.friction = 0.5;
    constexpr double imbalance = 1e-5, length = 0.05;
    constexpr std::uint64_t number = 40;
    GrainSetup setup = dumbbells(rough, 2e-5);
    setup.box = {3, {0, 0, 0}, {length, length, 0}, {Boundary::periodic, Boundary::periodic, Boundary::open}};
    setup.gravity = {0, 0, -9.81};
    setup.walls.push_back({"floor", 0, dem::PlaneShape{{}, {0, 0, 1}}, {}});
    GrainSource rain{.name = "rain",
                     .body = 0,
                     .density = rough.density,
                     .region = BoxShape{{0, 0, 0.01}, {length, length, 0.08}},
                     .clump = setup.clumps[0].shape,
                     .turned = true,
                     .rate = 1e6,
                     .total = number,
                     .begin = -5};
    rain.tries = 1000;
    setup.flow = {{}, {rain}, 11};
    setup.settling =
        GrainSettling{.imbalance = imbalance, .lasting = 3, .interval = 100, .longest = 5, .damping = 0.02};
    GrainSimulation run(comm, setup, clump_set(comm, setup, {}));
    run.start();
    while (run.time() < 0) run.step();
    const GrainTotals totals = run.totals();
    EXPECT_EQ(totals.grains, number);
    EXPECT_EQ(run.total_grains(), 2 * number);
    const double weight = 9.81 * static_cast<double>(number) * setup.clumps[0].mass();
    EXPECT_NEAR(totals.wall_forces[0][2], -weight, 10 * imbalance * weight);
    EXPECT_GT(totals.contacts, 2 * number);

    const double height = 0.2, volume = length * length * height;
    const WatchedRegion all{"all", BoxShape{{0, 0, 0}, {length, length, height}}};
    const RegionState state = region_states(comm, run.grains(), run.setup().box, run.clumps(), 1, {&all, 1},
                                            run.loaded_contacts())[0];
    EXPECT_EQ(state.count, number);
    EXPECT_NEAR(state.mass, totals.mass, 1e-14 * totals.mass);
    EXPECT_NEAR(state.solid_fraction, static_cast<double>(number) * setup.clumps[0].shape->volume / volume,
                1e-14);
    EXPECT_NEAR(state.stress[2] * volume, totals.potential_energy, 1e-3 * totals.potential_energy);
}

// A clump that moves no finite way stops the run by a sphere of its own.
TEST(Clumps, OneThatIsNotFiniteStopsTheRun) {
    const Communicator comm(MPI_COMM_SELF);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const auto& [speed, angular_momentum] : {std::pair{nan, 0.0}, {0.0, nan}}) {
        const GrainSetup setup = dumbbells(hard, 1e-6);
        GrainSimulation run(
            comm, setup,
            clump_set(comm, setup,
                      {{{}, {}, {}, {}}, {{0.1, 0, 0}, {0, speed, 0}, {}, {0, 0, angular_momentum}}}));
        try {
            run.start();
            for (int k = 0; k < 3; ++k) run.step();
            ADD_FAILURE() << "no stop";
        } catch (const AgreedError& error) {
            EXPECT_NE(std::string(error.what()).find("of grain 2 is not finite"), std::string::npos)
                << error.what();
        }
    }
}

}  // namespace
}  // namespace talus::test
