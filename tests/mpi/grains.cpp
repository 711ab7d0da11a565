#include <gtest/gtest.h>

#include "domain/grain_fields.hpp"
#include "tests/support/gathered.hpp"
#include "tests/support/grain_setups.hpp"

/// Grains and what their contacts remember have the same bits on any number of ranks, whoever owns what,
/// however often lists are made, and across an interruption in the middle of contacts.
namespace talus::test {
namespace {

constexpr int steps = 120;

std::uint64_t hash_of(const Communicator& comm, GrainSimulation& run) {
    const ParticleSet contacts = run.save();
    const std::uint64_t hash = state_hash(comm, run.grains()) * 31 + state_hash(comm, contacts);
    return run.setup().bonds.empty() ? hash : hash * 31 + state_hash(comm, run.saved_bonds());
}

struct Tested {
    const char* name;
    GrainSetup (*setup)();
    ParticleSet (*grains)(const Communicator&, const GrainSetup&);
};

struct How {
    PartitionMethod partition = PartitionMethod::metis;
    int rebalance_interval = 10;
    double skin = 0.0005;
};

GrainSimulation prepared(const Communicator& comm, GrainSetup setup, const How& how, ParticleSet grains) {
    setup.partition = how.partition;
    setup.rebalance_interval = how.rebalance_interval;
    setup.skin = how.skin;
    return {comm, setup, std::move(grains)};
}

GrainSimulation prepared(const Communicator& comm, const Tested& tested, const How& how) {
    const GrainSetup setup = tested.setup();
    return prepared(comm, setup, how, tested.grains(comm, setup));
}

std::uint64_t hash_after(const Communicator& comm, const Tested& tested, const How& how) {
    GrainSimulation run = prepared(comm, tested, how);
    run.start();
    for (int k = 0; k < steps; ++k) run.step();
    return hash_of(comm, run);
}

class GrainsSameBits : public testing::TestWithParam<Tested> {
  protected:
    void SetUp() override {
        const Communicator alone(MPI_COMM_SELF);
        serial_hash_ = hash_after(alone, GetParam(), {});
    }
    std::uint64_t serial_hash_ = 0;
};

TEST_P(GrainsSameBits, RunDoesSomething) {
    const Communicator alone(MPI_COMM_SELF);
    GrainSimulation run = prepared(alone, GetParam(), {});
    run.start();
    std::vector<bool> pressed(run.setup().walls.size());
    for (int k = 0; k < steps; ++k) {
        run.step();
        const auto forces = run.totals().wall_forces;
        for (std::size_t w = 0; w < forces.size(); ++w) pressed[w] = pressed[w] || forces[w][2] != 0;
    }
    const GrainTotals totals = run.totals();
    const bool bonded = !run.setup().bonds.empty();
    EXPECT_GT(totals.contacts, bonded ? 5U : 100U);
    EXPECT_EQ(totals.bonds > 300, bonded);
    EXPECT_EQ(totals.broken_bonds > 300, bonded);
    EXPECT_TRUE(totals.wall_contacts > 10U || run.setup().walls.empty());
    EXPECT_GT(run.list_count(), 10U);
    for (std::size_t w = 0; w < pressed.size(); ++w) EXPECT_TRUE(pressed[w]) << run.setup().walls[w].name;
    EXPECT_EQ(hash_of(alone, run), serial_hash_) << "two equal runs differ";
}

TEST_P(GrainsSameBits, WhoeverOwnsWhat) {
    const Communicator world(MPI_COMM_WORLD);
    constexpr How hows[] = {{PartitionMethod::metis, 1, 0.0005},    {PartitionMethod::metis, 0, 0.0002},
                            {PartitionMethod::cheapest, 1, 0.0005}, {PartitionMethod::bisection, 1, 0.001},
                            {PartitionMethod::slabs, 0, 0.0005},    {PartitionMethod::scrambled, 1, 0.002}};
    const GrainSetup setup = GetParam().setup();
    // Bonds that break, and clumps that come and go, make lists anew: dear.
    const bool dear = !setup.bonds.empty() || (!setup.clumps.empty() && !setup.flow.empty());
    for (const How& how : hows) {
        if (dear && how.partition != PartitionMethod::cheapest && how.partition != PartitionMethod::scrambled)
            continue;
        EXPECT_EQ(hash_after(world, GetParam(), how), serial_hash_)
            << "method " << static_cast<int>(how.partition) << ", skin " << how.skin;
    }
}

TEST_P(GrainsSameBits, AfterInterruption) {
    const Communicator world(MPI_COMM_WORLD);
    const GrainSetup setup = GetParam().setup();
    for (const int stop : {1, 101}) {
        GrainSimulation first = prepared(world, GetParam(), {});
        first.start();
        for (int k = 0; k < stop; ++k) first.step();
        const ParticleSet contacts = first.save();
        std::map<std::string, double> numbers;
        first.save_numbers(numbers);
        const GatheredState saved_grains = gather_state(world, first.grains()),
                            saved_contacts = gather_state(world, contacts);
        EXPECT_TRUE(stop == 1 || saved_contacts.ids.size() > 30);
        const bool bonded = !first.setup().bonds.empty();
        GatheredState saved_bonds;
        if (bonded) saved_bonds = gather_state(world, first.saved_bonds());
        // Each rank takes an equal share in order of id, as from a checkpoint.
        const auto share = [&](const GatheredState& state) {
            return [&, total = state.ids.size()](std::size_t k) {
                return k * static_cast<std::size_t>(world.size()) / total ==
                       static_cast<std::size_t>(world.rank());
            };
        };
        ParticleSet grains("grains", 3);
        GrainSimulation::add_fields(grains, setup);
        if (bonded) grains.add(field::broken_bonds);
        fill(grains, saved_grains, share(saved_grains));
        ParticleSet read = dem::empty_contacts(3, GrainSimulation::history_fields(setup));
        fill(read, saved_contacts, share(saved_contacts));
        ParticleSet read_bonds = dem::empty_pairs("bonds", 3, dem::BondList::fields());
        if (bonded) fill(read_bonds, saved_bonds, share(saved_bonds));
        GrainSimulation second =
            prepared(world, setup, {PartitionMethod::bisection, 5, 0.0007}, std::move(grains));
        second.resume(first.time(), first.step_count(), numbers, read, bonded ? &read_bonds : nullptr);
        for (int k = stop; k < steps; ++k) second.step();
        EXPECT_EQ(hash_of(world, second), serial_hash_) << "stopped at step " << stop;
        // Saving must not have changed the run that was saved either.
        for (int k = stop; k < steps; ++k) first.step();
        EXPECT_EQ(hash_of(world, first), serial_hash_) << "saved at step " << stop;
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, GrainsSameBits,
                         testing::Values(Tested{"SpheresOnAFloor", on_a_floor, spheres},
                                         Tested{"MixtureOnAFloor", on_a_floor, many_sizes},
                                         Tested{"SpheresInADrum", in_a_drum, spheres},
                                         Tested{"StickyOnAFloor", sticky_on_a_floor, spheres},
                                         Tested{"BondedOnAFloor", bonded_on_a_floor, spheres},
                                         Tested{"ClumpsOnAFloor", clumps_on_a_floor, clumps},
                                         Tested{"ClumpsComeAndGo", clumps_come_and_go, clumps},
                                         Tested{"Sheared", sheared, spheres},
                                         Tested{"ClumpsSheared", clumps_sheared, clumps},
                                         Tested{"ComeAndGo", come_and_go, spheres},
                                         Tested{"ComeAndGoInADrum", come_and_go_in_a_drum, spheres},
                                         Tested{"SettleFirst", settle_first, spheres}),
                         [](const auto& tested) { return tested.param.name; });
}  // namespace
}  // namespace talus::test
