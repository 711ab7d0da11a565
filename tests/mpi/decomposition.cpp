#include "comm/decomposition.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "domain/boundary.hpp"
#include "domain/random.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/gathered.hpp"

namespace talus::test {
namespace {

constexpr PartitionMethod methods[] = {PartitionMethod::cheapest, PartitionMethod::metis,
                                       PartitionMethod::bisection, PartitionMethod::slabs,
                                       PartitionMethod::scrambled};
constexpr RandomStream draws{.seed = 31};

/// All particles on the last rank: the others start empty.
ParticleSet all_on_last_rank(const Communicator& comm, const Cloud& cloud) {
    return make_particles(cloud,
                          comm.rank() == comm.size() - 1 ? all_points(cloud) : std::vector<std::size_t>{});
}

CellKey key_at(const CellGrid& grid, const ParticleSet& particles, std::size_t i) {
    Cell cell{};
    for (int axis = 0; axis < particles.dimension(); ++axis)
        cell[static_cast<std::size_t>(axis)] =
            grid.index_along(axis, particles.data(field::position, axis)[i]);
    return key_of(cell);
}

/// Stored by (cell, id), the list of own cells right, and every block of cells with one rank alone.
void expect_in_place(const Communicator& comm, const CellGrid& grid, const ParticleSet& particles,
                     const Decomposition& decomposition) {
    const auto id = particles.own(field::id);
    for (std::size_t i = 1; i < particles.size(); ++i) {
        const CellKey before = key_at(grid, particles, i - 1), here = key_at(grid, particles, i);
        ASSERT_TRUE(before < here || (before == here && id[i - 1] < id[i])) << "order at " << i;
    }
    std::uint32_t next = 0;
    std::set<std::uint64_t> blocks;
    for (const CellEntry& cell : decomposition.own_cells()) {
        ASSERT_EQ(cell.begin, next);
        ASSERT_LT(cell.begin, cell.end);
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) ASSERT_EQ(key_at(grid, particles, i), cell.key);
        next = cell.end;
        blocks.insert(block_key_of(cell_of(cell.key), 1));
    }
    ASSERT_EQ(next, particles.size());
    const std::vector<std::uint64_t> mine(blocks.begin(), blocks.end());
    auto all = comm.all_gather(std::span<const std::uint64_t>(mine));
    std::sort(all.begin(), all.end());
    ASSERT_EQ(std::adjacent_find(all.begin(), all.end()), all.end()) << "a block with two owners";
}

TEST(Decomposition, ArrangesEveryCloudWithoutLossOrChange) {
    const Communicator comm(MPI_COMM_WORLD);
    for (const Cloud& cloud : all_clouds())
        for (const PartitionMethod method : methods) {
            SCOPED_TRACE(cloud.name + ", method " + std::to_string(static_cast<int>(method)));
            const CellGrid grid(cloud.box, cloud.radius, cells_per_radius);
            ParticleSet particles = all_on_last_rank(comm, cloud);
            const GatheredState before = gather_state(comm, particles);
            Decomposition decomposition(comm, method);
            decomposition.expect(particles);
            EXPECT_EQ(decomposition.total_particles(), cloud.points.size());
            decomposition.divide(particles, grid);
            decomposition.arrange(particles, grid);
            expect_in_place(comm, grid, particles, decomposition);
            EXPECT_EQ(gather_state(comm, particles), before);
            decomposition.arrange(particles, grid);
            expect_in_place(comm, grid, particles, decomposition);
            EXPECT_EQ(gather_state(comm, particles), before);
        }
}

TEST(Decomposition, WorksWithoutParticles) {
    const Communicator comm(MPI_COMM_WORLD);
    const Cloud cloud{"nothing", {}, 1.0, {}};
    ParticleSet particles = all_on_last_rank(comm, cloud);
    const CellGrid grid(cloud.box, 1.0, cells_per_radius);
    Decomposition decomposition(comm, PartitionMethod::metis);
    decomposition.expect(particles);
    decomposition.divide(particles, grid);
    decomposition.arrange(particles, grid);
    EXPECT_FALSE(decomposition.rebalance({}));
    decomposition.arrange(particles, grid);
    EXPECT_EQ(particles.size_with_halo(), 0u);
}

/// Moves every particle by up to `far` along each axis, depending on its id and the step alone.
void scatter(ParticleSet& particles, const Box& box, double far, std::uint32_t step) {
    for (int axis = 0; axis < particles.dimension(); ++axis)
        for (std::size_t i = 0; i < particles.size(); ++i)
            particles.data(field::position, axis)[i] +=
                far * 2 *
                (draws.uniform(particles.data(field::id)[i], 3 * step + static_cast<std::uint32_t>(axis)) -
                 0.5);
    apply_boundaries(particles, box);
}

std::vector<double> random_work(const Decomposition& decomposition, std::uint32_t step) {
    std::vector<double> work;
    for (const CellEntry& cell : decomposition.own_cells())
        work.push_back(draws.uniform(cell.key, 1000 + step));
    return work;
}

TEST(Decomposition, FollowsParticlesThatCrossManyBlocksAStep) {
    const Communicator comm(MPI_COMM_WORLD), alone(MPI_COMM_SELF);
    for (const Cloud& cloud : all_clouds())
        for (const PartitionMethod method : methods) {
            if (comm.size() == 1 && method != PartitionMethod::metis) continue;
            SCOPED_TRACE(cloud.name + ", method " + std::to_string(static_cast<int>(method)));
            const CellGrid grid(cloud.box, cloud.radius, cells_per_radius);
            ParticleSet particles = all_on_last_rank(comm, cloud),
                        serial = make_particles(cloud, all_points(cloud));
            Decomposition decomposition(comm, method);
            decomposition.expect(particles);
            decomposition.divide(particles, grid);
            decomposition.arrange(particles, grid);
            for (std::uint32_t step = 0; step < 20; ++step) {
                // Now and then far, else so that most stay in their cells.
                const double far = step % 3 == 0 ? 6 * cloud.radius : 0.1 * cloud.radius;
                scatter(particles, cloud.box, far, step);
                scatter(serial, cloud.box, far, step);
                decomposition.rebalance(random_work(decomposition, step));
                decomposition.arrange(particles, grid);
                expect_in_place(comm, grid, particles, decomposition);
            }
            EXPECT_EQ(gather_state(comm, particles), gather_state(alone, serial));
        }
}

TEST(Decomposition, ChangesItsGrid) {
    const Communicator comm(MPI_COMM_WORLD);
    const Cloud cloud = all_clouds()[9];
    ParticleSet particles = all_on_last_rank(comm, cloud);
    const GatheredState before = gather_state(comm, particles);
    Decomposition decomposition(comm, PartitionMethod::metis);
    decomposition.expect(particles);
    for (const double radius : {0.2, 0.1, 0.21, 0.3, 0.2}) {
        const CellGrid grid(cloud.box, radius, cells_per_radius);
        decomposition.divide(particles, grid);
        decomposition.arrange(particles, grid);
        expect_in_place(comm, grid, particles, decomposition);
    }
    // Another box with cells as wide as before: former cells mean nothing.
    Box shifted = cloud.box;
    for (std::size_t a = 0; a < 3; ++a) {
        shifted.lower[a] -= 0.07;
        shifted.upper[a] -= 0.07;
    }
    const CellGrid grid(shifted, 0.2, cells_per_radius);
    decomposition.arrange(particles, grid);
    expect_in_place(comm, grid, particles, decomposition);
    EXPECT_EQ(gather_state(comm, particles), before);
}

TEST(Decomposition, DoesNotMindASetShuffledMeanwhile) {
    const Communicator comm(MPI_COMM_WORLD);
    const Cloud cloud = all_clouds()[2];
    const CellGrid grid(cloud.box, cloud.radius, cells_per_radius);
    ParticleSet particles = all_on_last_rank(comm, cloud);
    Decomposition decomposition(comm, PartitionMethod::bisection);
    decomposition.expect(particles);
    decomposition.divide(particles, grid);
    decomposition.arrange(particles, grid);
    std::vector<std::uint32_t> order(particles.size());
    for (std::size_t k = 0; k < order.size(); ++k)
        order[k] = static_cast<std::uint32_t>(order.size() - 1 - k);
    if (order.size() > 10) std::swap(order[3], order[7]);
    particles.reorder(order);
    decomposition.arrange(particles, grid);
    expect_in_place(comm, grid, particles, decomposition);
}

std::string failure_of_arrange(Decomposition& decomposition, ParticleSet& particles, const CellGrid& grid) {
    try {
        decomposition.arrange(particles, grid);
    } catch (const AgreedError& error) {
        EXPECT_EQ(error.exit_code, 1);
        return error.what();
    }
    return "no error";
}

TEST(Decomposition, NamesALostOrDoubledParticleOnAllRanks) {
    const Communicator comm(MPI_COMM_WORLD);
    const Cloud cloud = all_clouds()[2];
    const CellGrid grid(cloud.box, cloud.radius, cells_per_radius);
    for (int culprit = 0; culprit < comm.size(); ++culprit) {
        ParticleSet particles = all_on_last_rank(comm, cloud);
        Decomposition decomposition(comm, PartitionMethod::metis);
        decomposition.expect(particles);
        decomposition.divide(particles, grid);
        decomposition.arrange(particles, grid);
        std::uint64_t id = 0;
        std::vector<std::uint32_t> order(particles.size());
        for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<std::uint32_t>(k);
        if (comm.rank() == culprit) {
            id = particles.data(field::id)[5];
            order.erase(order.begin() + 5);
        }
        id = comm.all_max(id);
        particles.reorder(order);
        EXPECT_EQ(failure_of_arrange(decomposition, particles, grid),
                  "particle set 'cloud': 800 particles expected, 799 found; lost: id " + std::to_string(id));
    }
    ParticleSet particles = all_on_last_rank(comm, cloud);
    Decomposition decomposition(comm, PartitionMethod::metis);
    decomposition.expect(particles);
    const bool last = comm.rank() == comm.size() - 1;
    std::vector<std::uint32_t> order(particles.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<std::uint32_t>(k);
    std::uint64_t id = last ? particles.data(field::id)[9] : 0;
    id = comm.all_max(id);
    if (last) order.push_back(9);
    particles.reorder(order);
    decomposition.divide(particles, grid);
    EXPECT_EQ(
        failure_of_arrange(decomposition, particles, grid),
        "particle set 'cloud': 800 particles expected, 801 found; found twice: id " + std::to_string(id));
    if (last) particles.resize(0);
    decomposition.expect(particles);
}

TEST(Decomposition, RebalancingLowersTheImbalance) {
    const Communicator comm(MPI_COMM_WORLD);
    if (comm.size() == 1) GTEST_SKIP() << "nothing to balance on one rank";
    Cloud cloud{"cube", {}, 0.0625, {}};
    for (std::size_t k = 0; k < 20000; ++k)
        cloud.points.push_back({draws.uniform(k, 0), draws.uniform(k, 1), draws.uniform(k, 2)});
    const CellGrid grid(cloud.box, cloud.radius, cells_per_radius);
    ParticleSet particles = all_on_last_rank(comm, cloud);
    Decomposition decomposition(comm, PartitionMethod::metis);
    decomposition.expect(particles);
    decomposition.divide(particles, grid);
    decomposition.arrange(particles, grid);
    const auto work = [&] {  // particles of one octant cost ten times as much
        std::vector<double> result;
        for (const CellEntry& cell : decomposition.own_cells())
            result.push_back((cell.end - cell.begin) *
                             (std::ranges::max(cell_of(cell.key)) < 16 ? 10.0 : 1.0));
        return result;
    };
    EXPECT_TRUE(decomposition.rebalance(work()));
    const double before = decomposition.measured_imbalance();
    decomposition.arrange(particles, grid);
    decomposition.rebalance(work());
    EXPECT_GT(before, 1.3);
    EXPECT_LT(decomposition.measured_imbalance(), 1.1);
}

}  // namespace
}  // namespace talus::test
