#include <gtest/gtest.h>

#include <cmath>

#include "domain/grain_fields.hpp"
#include "tests/support/gathered.hpp"
#include "tests/support/grain_scene.hpp"

/// A cloud of grains that falls together, pushed a little, has the same bits on any number of ranks, whoever
/// owns what, with one impulse of gravity for several steps, and across an interruption.
namespace talus::test {
namespace {

constexpr int steps = 80;
constexpr double radius = 10;

const dem::GrainMaterial rock{.name = "rock",
                              .density = 2500,
                              .youngs_modulus = 1e5,
                              .poisson_ratio = 0.25,
                              .restitution = 0.5,
                              .friction = 0.6};

std::vector<GrainState> cloud() {
    std::vector<GrainState> grains;
    for (int k = 0; k < 500; ++k) {
        const dem::Vector3<> cell{double(k % 8), double(k / 8 % 8), double(k / 64)};
        const dem::Vector3<> inward = dem::Vector3<>{3.5, 3.5, 3.5} - cell;
        const dem::Vector3<> stirred{std::sin(3.0 * k), std::cos(5.0 * k), std::sin(7.0 * k)};
        grains.push_back({2.02 * radius * cell,
                          0.02 * inward + 0.01 * stirred,
                          {},
                          k % 3 == 0 ? radius : 0.8 * radius,
                          2500});
    }
    return grains;
}

struct How {
    PartitionMethod partition = PartitionMethod::metis;
    int rebalance_interval = 10, interval = 4;
    gravity::Opening opening = gravity::Opening::geometric;
    bool clumps = false;  ///< dumbbells in place of the spheres
};

GrainSetup setup_of(const How& how) {
    GrainSetup setup = grain_setup({rock}, radius, 2);
    if (how.clumps) {
        const std::vector<dem::Vector3<>> ends{{-0.4 * radius, 0, 0}, {0.5 * radius, 0, 0}};
        const std::vector<double> radii{0.6 * radius, 0.5 * radius};
        setup.clumps = {
            {std::make_shared<const dem::ClumpShape>(dem::clump_shape(ends, radii, 64)), 0, 2500}};
    }
    setup.partition = how.partition;
    setup.rebalance_interval = how.rebalance_interval;
    setup.self_gravity = SelfGravity{{.opening = how.opening}, how.interval};
    return setup;
}

GrainSimulation prepared(const Communicator& comm, const How& how, ParticleSet grains) {
    return {comm, setup_of(how), std::move(grains)};
}

ParticleSet new_grains(const Communicator& comm, const How& how) {
    if (how.clumps) {
        std::vector<dem::ClumpState> states;
        std::vector<GrainState> places = cloud();
        places.resize(256);
        for (const GrainState& grain : places) {
            const double half = norm(grain.position);
            states.push_back({0.9 * grain.position,
                              grain.velocity,
                              {std::cos(half), {0, 0.8 * std::sin(half), 0.6 * std::sin(half)}},
                              {}});
        }
        return clump_set(comm, setup_of(how), states);
    }
    ParticleSet grains = grain_set(comm, cloud());
    GrainGravity::add_fields(grains);
    return grains;
}

std::uint64_t hash_of(const Communicator& comm, GrainSimulation& run) {
    const ParticleSet contacts = run.save();
    return state_hash(comm, run.grains()) * 31 + state_hash(comm, contacts);
}

std::uint64_t hash_after(const Communicator& comm, const How& how) {
    GrainSimulation run = prepared(comm, how, new_grains(comm, how));
    run.start();
    for (int k = 0; k < steps; ++k) run.step();
    EXPECT_GT(run.totals().contacts, how.clumps ? 50U : 100U);
    EXPECT_TRUE(run.is_synchronous());
    return hash_of(comm, run);
}

TEST(GrainGravitySameBits, WhoeverOwnsWhat) {
    const Communicator world(MPI_COMM_WORLD), alone(MPI_COMM_SELF);
    for (const gravity::Opening opening : {gravity::Opening::geometric, gravity::Opening::relative}) {
        const std::uint64_t expected = hash_after(alone, {.opening = opening});
        for (const PartitionMethod partition : {PartitionMethod::metis, PartitionMethod::scrambled})
            EXPECT_EQ(hash_after(world, {partition, 3, 4, opening}), expected)
                << "method " << static_cast<int>(partition);
    }
    const std::uint64_t expected = hash_after(alone, {.clumps = true});
    for (const PartitionMethod partition : {PartitionMethod::metis, PartitionMethod::scrambled})
        EXPECT_EQ(hash_after(world, {.partition = partition, .rebalance_interval = 3, .clumps = true}),
                  expected)
            << "clumps, method " << static_cast<int>(partition);
}

class GrainGravityStopped : public testing::TestWithParam<bool> {};

TEST_P(GrainGravityStopped, GoesOnWithTheSameBits) {
    const Communicator world(MPI_COMM_WORLD), alone(MPI_COMM_SELF);
    const How how{.clumps = GetParam()};
    const std::uint64_t expected = hash_after(alone, how);
    GrainSimulation first = prepared(world, how, new_grains(world, how));
    first.start();
    for (int k = 0; k < 44; ++k) first.step();
    const ParticleSet contacts = first.save();
    // Each rank takes an equal share in order of id, as from a checkpoint.
    const auto share = [&](ParticleSet empty, const ParticleSet& from) {
        const GatheredState state = gather_state(world, from);
        const auto ranks = static_cast<std::size_t>(world.size()),
                   rank = static_cast<std::size_t>(world.rank());
        fill(empty, state, [&](std::size_t k) { return k * ranks / state.ids.size() == rank; });
        return empty;
    };
    ParticleSet empty("grains", 3);
    GrainSimulation::add_fields(empty, first.setup());
    GrainSimulation second = prepared(
        world, {.partition = PartitionMethod::bisection, .rebalance_interval = 5, .clumps = how.clumps},
        share(std::move(empty), first.grains()));
    second.resume(first.time(), first.step_count(), {},
                  share(dem::empty_contacts(3, GrainSimulation::history_fields(first.setup())), contacts));
    for (int k = 44; k < steps; ++k) second.step();
    EXPECT_EQ(hash_of(world, second), expected);
    for (int k = 44; k < steps; ++k) first.step();
    EXPECT_EQ(hash_of(world, first), expected) << "saving changed the run";
}
INSTANTIATE_TEST_SUITE_P(Grains, GrainGravityStopped, testing::Bool(),
                         [](const auto& clumps) { return clumps.param ? "Clumps" : "Spheres"; });

}  // namespace
}  // namespace talus::test
