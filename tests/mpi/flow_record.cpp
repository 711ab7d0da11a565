#include "src/depth/flow_record.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

#include "domain/flow_record_fields.hpp"
#include "io/hashing.hpp"
#include "random_particles.hpp"

namespace talus {
namespace {

TerrainGrid frame() {
    return {.origin = {1000, -20}, .spacing = {5, 4}, .columns = 40, .rows = 30, .elevations = {}};
}

/// Columns of a flow at some time: every one on one rank, in another order for every salt.
std::vector<MapColumn> columns_of_rank(const Communicator& comm, std::uint64_t salt, int time) {
    std::vector<MapColumn> mine;
    std::mt19937_64 owner(salt);
    for (int k = 0; k < 900; ++k) {
        std::mt19937_64 random(static_cast<std::uint64_t>(1000 * time + k));
        const auto uniform = [&](double low, double high) {
            return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
        };
        const MapColumn column{.place = {uniform(990, 1150), uniform(-30, 80)},
                               .area = uniform(1, 60),
                               .depth = uniform(0, 3),
                               .speed = uniform(0, 30)};
        if (owner() % static_cast<std::uint64_t>(comm.size()) == static_cast<std::uint64_t>(comm.rank()))
            mine.push_back(column);
    }
    std::shuffle(mine.begin(), mine.end(), owner);
    return mine;
}

std::vector<std::uint64_t> bits_of(const TerrainGrid& grid) {
    std::vector<std::uint64_t> bits;
    for (const double value : grid.elevations) bits.push_back(std::bit_cast<std::uint64_t>(value));
    return bits;
}

std::vector<SpreadColumn> spread_columns(const std::vector<MapColumn>& columns) {
    std::vector<SpreadColumn> spread;
    for (const MapColumn& column : columns)
        spread.push_back({column.place, column.depth * column.area, 1.5 * std::sqrt(column.area)});
    return spread;
}

TEST(FlowRecord, SameBitsFromAnyRanksAndAcrossARestart) {
    const Communicator comm(MPI_COMM_WORLD), self(MPI_COMM_SELF);
    FlowRecord alone(frame(), 0.1), together(frame(), 0.1);
    for (int time = 0; time < 4; ++time) {
        for (const MapColumn& column : columns_of_rank(self, 7, time)) alone.add(column, time);
        for (const MapColumn& column : columns_of_rank(comm, 8, time)) together.add(column, time);
        if (time == 1) {
            const ParticleSet saved = together.save(comm);
            together = FlowRecord(frame(), 0.1);
            together.restore(comm, saved);
        }
    }
    together.share(comm);
    EXPECT_EQ(bits_of(together.depths()), bits_of(alone.depths()));
    EXPECT_EQ(bits_of(together.speeds()), bits_of(alone.speeds()));
    EXPECT_EQ(bits_of(together.arrivals()), bits_of(alone.arrivals()));
    EXPECT_EQ(bits_of(spread_depths(comm, frame(), spread_columns(columns_of_rank(comm, 9, 0)))),
              bits_of(spread_depths(self, frame(), spread_columns(columns_of_rank(self, 3, 0)))));
}

TEST(FlowRecord, ALatticeOfColumnsLeavesNoGap) {
    const Communicator comm(MPI_COMM_WORLD);
    for (const double spacing : {1.7, 6.0, 11.0}) {
        FlowRecord record(frame(), 0.1);
        for (double x = 990; x < 1220; x += spacing)
            for (double y = -40; y < 120; y += spacing) record.add({{x, y}, spacing * spacing, 2, 3}, 7);
        record.share(comm);
        for (const double depth : record.depths().elevations) EXPECT_EQ(depth, 2);
        for (const double time : record.arrivals().elevations) EXPECT_EQ(time, 7);
    }
}

TEST(FlowRecord, KeepsTheGreatestAndTheFirst) {
    const Communicator comm(MPI_COMM_SELF);
    FlowRecord record(frame(), 0.1);
    const std::array<double, 2> place{1011, -12.5};  // in the cell at column 2, row 2 from the south
    record.add({place, 1, 0.05, 90}, 1);             // below the threshold
    record.add({place, 1, 2, 5}, 2);
    record.add({place, 1, 1, 8}, 3);
    record.add({{2000, 0}, 1, 9, 9}, 3);  // beyond the raster
    record.share(comm);
    const std::size_t cell = 2 * 40 + 2;
    EXPECT_EQ(record.depths().elevations[cell], 2);
    EXPECT_EQ(record.speeds().elevations[cell], 8);
    EXPECT_EQ(record.arrivals().elevations[cell], 2);
    const TerrainGrid depths = record.depths();
    EXPECT_EQ(std::count_if(depths.elevations.begin(), depths.elevations.end(),
                            [](double depth) { return !std::isnan(depth); }),
              1);
}

/// Tolerance: half a unit of 2^-40 m for each column and cell.
TEST(FlowRecord, SpreadDepthsKeepTheVolume) {
    const Communicator comm(MPI_COMM_SELF);
    std::vector<SpreadColumn> columns;
    double volume = 0;
    for (int k = 0; k < 50; ++k) {
        columns.push_back({{1040 + 2.3 * k / 3, 20 + 0.7 * k}, 3.0 + k, 0.1 + 0.4 * k});
        volume += 3.0 + k;
    }
    double sum = 0;
    for (const double depth : spread_depths(comm, frame(), columns).elevations)
        if (!std::isnan(depth)) sum += 20 * depth;
    EXPECT_NEAR(sum, volume, 1e-6);
}

}  // namespace
}  // namespace talus
