#include <gtest/gtest.h>

#include <cmath>

#include "domain/grain_fields.hpp"
#include "tests/support/grain_setups.hpp"

/// Grains that come and go, and the ledger of them.
namespace talus::test {
namespace {

constexpr int steps = 120;

GrainSimulation prepared(const Communicator& comm, GrainSetup setup,
                         ParticleSet (*grains)(const Communicator&, const GrainSetup&) = spheres) {
    setup.partition = PartitionMethod::metis;
    return {comm, setup, grains(comm, setup)};
}

TEST(GrainFlow, LedgerHoldsWhatCameAndWent) {
    const Communicator world(MPI_COMM_WORLD);
    GrainSimulation run = prepared(world, come_and_go());
    run.start();
    for (int k = 0; k < steps; ++k) run.step();
    const GrainFlow::Came& rain = run.flow().came()[0];
    const auto gone = run.flow().passed();
    EXPECT_GT(gone[0].count, 10U);
    EXPECT_GT(gone[1].count, 20U);
    EXPECT_GT(rain.count, 50U);
    EXPECT_GT(rain.missed, 5U);
    EXPECT_EQ(rain.count + rain.missed, rain.attempts);
    EXPECT_EQ(run.total_grains(), 700 + rain.count - gone[0].count - gone[1].count);
    EXPECT_EQ(run.take_notes().size(), 1U) << "that the source is full is said once";
    double first = 0;
    for (const GrainState& grain : cloud()) first += mass_of(grain);
    EXPECT_NEAR(run.totals().mass, first + rain.mass - gone[0].mass - gone[1].mass, 1e-12 * first)
        << "masses of events, rounded once each";
}

// Every clump is whole, those that came across the periodic edges too, and the ledger counts it once.
TEST(GrainFlow, ClumpsComeAndGoWhole) {
    const Communicator world(MPI_COMM_WORLD);
    const GrainSetup setup = clumps_come_and_go();
    GrainSimulation run = prepared(world, setup, clumps);
    run.start();
    for (int k = 0; k < steps; ++k) run.step();
    const auto came = run.flow().came();
    const auto gone = run.flow().passed();
    EXPECT_EQ(came[0].count, 40U);
    EXPECT_GT(came[1].count, 5U);
    EXPECT_GT(came[1].missed, 0U);
    EXPECT_GT(came[2].count, 5U);
    EXPECT_GT(gone[0].count, 3U);
    const GrainTotals totals = run.totals();
    EXPECT_EQ(totals.grains, 700 + came[0].count + came[1].count + came[2].count - gone[0].count);
    const double mass = 700 * setup.clumps[0].mass() + came[0].mass + came[1].mass + came[2].mass;
    EXPECT_NEAR(totals.mass, mass - gone[0].mass, 1e-12 * mass);
    EXPECT_NEAR(came[0].mass, 40 * setup.clumps[1].mass(), 1e-14);
    std::vector<std::uint64_t> counts(6);  // of spheres by body and place in their clump; of single ones
    const ParticleSet& grains = run.grains();
    for (std::size_t i = 0; i < grains.size(); ++i) {
        const std::uint8_t body = grains.data(field::body)[i];
        const dem::ClumpBody* clump = run.clumps().of_body(body);
        if (!clump) ++counts[5];
        if (!clump) continue;
        const std::uint64_t sphere = clump->sphere(grains.data(field::id)[i]);
        EXPECT_EQ(grains.data(field::radius)[i], clump->shape->radii[sphere]);
        ++counts[(body == 0 ? 0 : 3) + sphere];
    }
    world.all_sum(std::span<std::uint64_t>(counts));
    EXPECT_EQ(counts[0], counts[1]);
    EXPECT_EQ(counts[0], counts[2]);
    EXPECT_EQ(counts[3], counts[4]);
    EXPECT_EQ(counts[0] + counts[3] + counts[5], totals.grains);
}

TEST(GrainFlow, TheDrumLosesAndGainsGrains) {
    const Communicator world(MPI_COMM_WORLD);
    GrainSimulation run = prepared(world, come_and_go_in_a_drum());
    run.start();
    for (int k = 0; k < steps; ++k) run.step();
    EXPECT_GT(run.flow().passed()[0].count, 5U);
    EXPECT_GT(run.flow().came()[0].count, 5U);
}

// A shell that fills a fiftieth of the box around it: every grain lies in it all the same.
TEST(GrainFlow, GrainsComeIntoTheirRegionOnly) {
    const Communicator world(MPI_COMM_WORLD);
    GrainSetup setup = grain_setup({glass}, 0.01, 2e-5);
    GrainSource shell{.name = "shell", .body = 0, .density = 2500, .region = SphereShape{{}, 1, 0.97}};
    shell.sizes.least = shell.sizes.greatest = 0.01;
    shell.rate = 1e6;
    shell.total = 200;
    setup.flow = {{}, {shell}, 3};
    GrainSimulation run(world, setup, grain_set(world, {}));
    run.start();
    for (int k = 0; k < 20; ++k) run.step();
    EXPECT_GT(run.flow().came()[0].count, 150U);
    for (std::size_t i = 0; i < run.grains().size(); ++i) {
        double distance2 = 0;
        for (int axis = 0; axis < 3; ++axis)
            distance2 +=
                run.grains().data(field::position, axis)[i] * run.grains().data(field::position, axis)[i];
        EXPECT_GT(std::sqrt(distance2), 0.97 - 1e-3);
        EXPECT_LT(std::sqrt(distance2), 1 + 1e-3);
    }
}

// Time 0 waits for a source that begins later than the grains there are come to rest.
TEST(GrainFlow, SettlingWaitsForSourcesThatBeginLater) {
    const Communicator world(MPI_COMM_WORLD);
    GrainSetup setup = settle_first();
    setup.flow.sources[0].begin = -0.05;
    setup.settling->imbalance = 1e9;  // quiet at once but for the source
    GrainSimulation run = prepared(world, setup);
    run.start();
    while (run.time() < 0) run.step();
    EXPECT_EQ(run.flow().came()[0].count, 40U);
}

TEST(GrainFlow, SettlingEndsAtTimeZeroOrWithAnError) {
    const Communicator world(MPI_COMM_WORLD);
    GrainSimulation run = prepared(world, settle_first());
    run.start();
    EXPECT_EQ(run.time(), -0.1);
    while (run.time() < 0) run.step();
    EXPECT_EQ(run.time(), 0);
    EXPECT_GT(run.step_count(), 10U);
    EXPECT_LT(run.step_count(), 100U) << "an interruption at step 1 and another at 101 are on either side";
    EXPECT_EQ(run.flow().came()[0].count, 40U);
    GrainSetup strict = settle_first();
    strict.settling->imbalance = 1e-9;
    strict.settling->longest = 0.001;
    GrainSimulation never(world, strict, grain_set(world, cloud()));
    never.start();
    const auto until_zero = [&] {
        while (never.time() < 0) never.step();
    };
    EXPECT_THROW(until_zero(), AgreedError);
}

TEST(GrainFlow, LedgerThatDoesNotAddUpIsRefused) {
    const Communicator world(MPI_COMM_WORLD);
    GrainSimulation run = prepared(world, come_and_go());
    const std::map<std::string, double> numbers{{"flow.first_count", 701}};
    const ParticleSet none = dem::empty_contacts(3, GrainSimulation::history_fields(come_and_go()));
    EXPECT_THROW(run.resume(0, 0, numbers, none), AgreedError);
}

}  // namespace
}  // namespace talus::test
