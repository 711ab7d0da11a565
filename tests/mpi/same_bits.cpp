#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

#include "tests/support/gathered.hpp"
#include "tests/support/scenes.hpp"

/// The invariant of the project: the bits of a run depend neither on the number of ranks, nor on who owns
/// what, nor on interruptions.
namespace talus::test {
namespace {

constexpr int steps = 30;

/// How particles lie on ranks before the first arrangement.
enum class Spread { root, round_robin, id_ranges };

ParticleSet share_of(const Communicator& comm, const SmallScene& scene, const GatheredState& state,
                     Spread spread) {
    ParticleSet mine(scene.particles.name(), scene.particles.dimension());
    add_fields(mine, scene.setup);
    const auto ranks = static_cast<std::size_t>(comm.size()), rank = static_cast<std::size_t>(comm.rank());
    fill(mine, state, [&](std::size_t k) {
        switch (spread) {
            case Spread::root:
                return rank == 0;
            case Spread::round_robin:
                return k % ranks == rank;
            case Spread::id_ranges:
                return k * ranks / state.ids.size() == ranks - 1 - rank;
        }
        return false;
    });
    return mine;
}

struct How {
    PartitionMethod partition = PartitionMethod::metis;
    int rebalance_interval = 10;
    Spread spread = Spread::root;
};

Simulation prepare(const Communicator& comm, const SmallScene& scene, const GatheredState& state,
                   const How& how) {
    Setup setup = scene.setup;
    setup.partition = how.partition;
    setup.rebalance_interval = how.rebalance_interval;
    return Simulation(comm, setup, share_of(comm, scene, state, how.spread));
}

std::uint64_t hash_after(const Communicator& comm, const SmallScene& scene, const How& how) {
    const Communicator alone(MPI_COMM_SELF);
    Simulation run = prepare(comm, scene, gather_state(alone, scene.particles), how);
    run.start();
    for (int k = 0; k < steps; ++k) run.step();
    return state_hash(comm, run.particles());
}

/// Hashes of runs by one rank, computed once a scene by every rank for itself.
std::uint64_t serial_hash(const SmallScene& scene) {
    static std::map<std::string, std::uint64_t> known;
    if (const auto at = known.find(scene.name); at != known.end()) return at->second;
    const Communicator alone(MPI_COMM_SELF);
    return known[scene.name] = hash_after(alone, scene, {});
}

/// The first `ranks` ranks of the world, or nothing on the others.
struct SubWorld {
    explicit SubWorld(int ranks) {
        int rank = 0;
        MPI_Comm_rank(MPI_COMM_WORLD, &rank);
        MPI_Comm_split(MPI_COMM_WORLD, rank < ranks ? 0 : MPI_UNDEFINED, rank, &handle);
    }
    ~SubWorld() {
        if (handle != MPI_COMM_NULL) MPI_Comm_free(&handle);
    }
    SubWorld(const SubWorld&) = delete;
    SubWorld& operator=(const SubWorld&) = delete;
    MPI_Comm handle = MPI_COMM_NULL;
};

/// Numbers of ranks to try, none above the world's.
std::vector<int> rank_counts(std::initializer_list<int> wanted, int most) {
    std::vector<int> counts;
    for (const int count : wanted)
        if (count <= most) counts.push_back(count);
    return counts;
}

class SameBits : public testing::TestWithParam<SmallScene (*)()> {};

TEST_P(SameBits, RunDoesSomething) {
    const SmallScene scene = GetParam()();
    const Communicator alone(MPI_COMM_SELF);
    EXPECT_NE(serial_hash(scene), state_hash(alone, scene.particles));
    Simulation run = prepare(alone, scene, gather_state(alone, scene.particles), {});
    run.start();
    const Totals before = run.totals();
    for (int k = 0; k < steps; ++k) run.step();
    const Totals after = run.totals();
    EXPECT_GT(run.pairs(), 5 * run.total_particles());
    EXPECT_GT(run.time(), 0);
    EXPECT_NE(before.greatest_pressure, after.greatest_pressure);
    if (run.particles().has(field::plastic_shear_strain)) {
        const auto strain = run.particles().own(field::plastic_shear_strain);
        EXPECT_GT(*std::max_element(strain.begin(), strain.end()), 1e-4);
    }
    if (run.particles().has(field::damage)) {
        EXPECT_GT(after.mean_damage, 1e-6);
    }
    EXPECT_EQ(state_hash(alone, run.particles()), serial_hash(scene)) << "two equal runs differ";
}

TEST_P(SameBits, OnAnyNumberOfRanks) {
    const SmallScene scene = GetParam()();
    const Communicator world(MPI_COMM_WORLD);
    const std::uint64_t expected = serial_hash(scene);
    for (const int ranks : rank_counts({1, 2, 3, 5, 8}, world.size())) {
        const SubWorld part(ranks);
        if (part.handle == MPI_COMM_NULL) continue;
        const Communicator comm(part.handle);
        EXPECT_EQ(hash_after(comm, scene, {.spread = Spread::round_robin}), expected) << ranks << " ranks";
    }
}

TEST_P(SameBits, WhoeverOwnsWhat) {
    const SmallScene scene = GetParam()();
    const Communicator world(MPI_COMM_WORLD);
    constexpr How hows[] = {{PartitionMethod::metis, 1, Spread::root},
                            {PartitionMethod::metis, 0, Spread::round_robin},
                            {PartitionMethod::bisection, 1, Spread::round_robin},
                            {PartitionMethod::slabs, 0, Spread::root},
                            {PartitionMethod::scrambled, 1, Spread::round_robin},
                            {PartitionMethod::scrambled, 0, Spread::root}};
    for (const How& how : hows)
        EXPECT_EQ(hash_after(world, scene, how), serial_hash(scene))
            << "method " << static_cast<int>(how.partition) << ", rebalance interval "
            << how.rebalance_interval;
}

TEST_P(SameBits, AfterInterruption) {
    const SmallScene scene = GetParam()();
    const Communicator world(MPI_COMM_WORLD);
    const Communicator alone(MPI_COMM_SELF);
    for (const int stop : {1, 17}) {
        Simulation first = prepare(world, scene, gather_state(alone, scene.particles), {});
        first.start();
        for (int k = 0; k < stop; ++k) first.step();
        const GatheredState saved = gather_state(world, first.particles());
        for (const int ranks : rank_counts({1, 2, 5}, world.size())) {
            const SubWorld part(ranks);
            if (part.handle == MPI_COMM_NULL) continue;
            const Communicator comm(part.handle);
            const How how{PartitionMethod::bisection, 5, Spread::id_ranges};
            Simulation second = prepare(comm, scene, saved, how);
            second.resume(first.time(), first.time_step(), first.step_count());
            for (int k = stop; k < steps; ++k) second.step();
            EXPECT_EQ(state_hash(comm, second.particles()), serial_hash(scene))
                << "stopped at step " << stop << ", resumed on " << ranks << " ranks";
        }
    }
}

std::string name_of(const testing::TestParamInfo<SmallScene (*)()>& scene) {
    constexpr const char* names[] = {"Rock2D", "Gas3D", "Gravity3D", "Walls2D", "Wave1D", "Soil2D"};
    return names[scene.index];
}
INSTANTIATE_TEST_SUITE_P(Scenes, SameBits,
                         testing::Values(rock_impact_2d, periodic_gas_3d, collapsing_gas_3d,
                                         gas_between_walls_2d, standing_wave_1d, soil_on_walls_2d),
                         name_of);

}  // namespace
}  // namespace talus::test
