#include "src/depth/flow_record.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "domain/flow_record_fields.hpp"

namespace talus {

namespace {

/// Calls visit(index, square of the distance) for the cells whose centres are within `reach` of a place, and
/// once with the cell that holds the place if that is not among them; only cells of the raster.
template <class Visit>
void for_each_cell(const TerrainGrid& frame, const std::array<double, 2>& place, double reach,
                   Visit&& visit) {
    std::array<long, 2> first, last, at;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const double centre = (place[axis] - frame.origin[axis]) / frame.spacing[axis],
                     half = reach / frame.spacing[axis];
        const auto count = static_cast<long>(axis == 0 ? frame.columns : frame.rows);
        at[axis] = std::lround(centre);
        first[axis] = std::max(0L, std::min(at[axis], std::lround(std::ceil(centre - half))));
        last[axis] = std::min(count - 1, std::max(at[axis], std::lround(std::floor(centre + half))));
    }
    for (long row = first[1]; row <= last[1]; ++row)
        for (long column = first[0]; column <= last[0]; ++column) {
            const double x = frame.origin[0] + frame.spacing[0] * static_cast<double>(column) - place[0],
                         y = frame.origin[1] + frame.spacing[1] * static_cast<double>(row) - place[1];
            const double distance2 = x * x + y * y;
            if (distance2 > reach * reach && !(column == at[0] && row == at[1])) continue;
            visit(static_cast<std::size_t>(row) * frame.columns + static_cast<std::size_t>(column),
                  distance2);
        }
}

}  // namespace

FlowRecord::FlowRecord(TerrainGrid frame, double threshold)
    : frame_(std::move(frame)), threshold_(threshold), cells_(frame_.columns * frame_.rows) {
    frame_.elevations = {};
}

void FlowRecord::mark(Cell& cell, const MapColumn& column, double time) const {
    cell.depth = std::max(cell.depth, static_cast<float>(column.depth));
    cell.speed = std::max(cell.speed, static_cast<float>(column.speed));
    cell.arrival = std::min(cell.arrival, static_cast<float>(time));
}

void FlowRecord::add(const MapColumn& column, double time) {
    if (!(column.depth > threshold_)) return;
    for_each_cell(frame_, column.place, std::sqrt(column.area / 2),
                  [&](std::size_t index, double) { mark(cells_[index], column, time); });
}

void FlowRecord::share(const Communicator& comm) {
    // A maximum of all three: arrival with its sign changed.
    static_assert(sizeof(Cell) == 3 * sizeof(float));
    for (Cell& cell : cells_) cell.arrival = -cell.arrival;
    constexpr std::size_t most = 1 << 24;  // cells in a message
    for (std::size_t first = 0; first < cells_.size(); first += most)
        comm.all_max(std::span<float>(&cells_[first].depth, 3 * std::min(most, cells_.size() - first)));
    for (Cell& cell : cells_) cell.arrival = -cell.arrival;
}

TerrainGrid FlowRecord::grid_of(float Cell::*what) const {
    TerrainGrid grid = frame_;
    grid.elevations.resize(cells_.size());
    for (std::size_t k = 0; k < cells_.size(); ++k)
        grid.elevations[k] = std::isfinite(cells_[k].arrival) ? static_cast<double>(cells_[k].*what)
                                                              : std::numeric_limits<double>::quiet_NaN();
    return grid;
}

ParticleSet FlowRecord::empty_set() {
    ParticleSet set("cells", 2);
    set.add(field::greatest_depth);
    set.add(field::greatest_speed);
    set.add(field::arrival_time);
    return set;
}

ParticleSet FlowRecord::save(const Communicator& comm) {
    share(comm);
    std::vector<std::size_t> wet;
    for (std::size_t k = 0; k < cells_.size(); ++k)
        if (std::isfinite(cells_[k].arrival)) wet.push_back(k);
    const auto ranks = static_cast<std::size_t>(comm.size()), rank = static_cast<std::size_t>(comm.rank());
    const std::size_t begin = wet.size() * rank / ranks, end = wet.size() * (rank + 1) / ranks;
    ParticleSet set = empty_set();
    set.resize(end - begin);
    for (std::size_t k = begin; k < end; ++k) {
        const std::size_t index = wet[k], row = k - begin;
        set.data(field::id)[row] = index;
        const std::array<double, 2> place = place_of(index);
        for (int axis = 0; axis < 2; ++axis)
            set.data(field::position, axis)[row] = place[static_cast<std::size_t>(axis)];
        set.data(field::greatest_depth)[row] = cells_[index].depth;
        set.data(field::greatest_speed)[row] = cells_[index].speed;
        set.data(field::arrival_time)[row] = cells_[index].arrival;
    }
    return set;
}

void FlowRecord::restore(const Communicator& comm, const ParticleSet& cells) {
    bool known = true;
    for (std::size_t k = 0; k < cells.size(); ++k) {
        const std::uint64_t index = cells.data(field::id)[k];
        const std::array<double, 2> place = place_of(index);
        known = known && index < cells_.size() && cells.data(field::position, 0)[k] == place[0] &&
                cells.data(field::position, 1)[k] == place[1];
        if (!known) break;
        cells_[index] = {cells.data(field::greatest_depth)[k], cells.data(field::greatest_speed)[k],
                         cells.data(field::arrival_time)[k]};
    }
    comm.all_agree(2,
                   known ? "" : "the checkpoint holds results of other cells than the scene's [results] has");
}

TerrainGrid spread_depths(const Communicator& comm, TerrainGrid frame,
                          const std::vector<SpreadColumn>& columns) {
    constexpr double unit = 0x1p-40;  // [m]
    const double cell_area = frame.spacing[0] * frame.spacing[1];
    std::vector<std::int64_t> sums(frame.columns * frame.rows);
    std::vector<std::pair<std::size_t, double>> shares;
    for (const SpreadColumn& column : columns) {
        shares.clear();
        double total = 0;
        for_each_cell(frame, column.place, column.reach, [&](std::size_t index, double distance2) {
            const double share = std::max(1e-6, 1 - distance2 / (column.reach * column.reach));
            shares.push_back({index, share});
            total += share;
        });
        for (const auto& [index, share] : shares)
            sums[index] += std::llround(column.volume * share / (total * cell_area) / unit);
    }
    constexpr std::size_t most = 1 << 26;  // cells in a message
    for (std::size_t first = 0; first < sums.size(); first += most)
        comm.all_sum(std::span<std::int64_t>(&sums[first], std::min(most, sums.size() - first)));
    frame.elevations.resize(sums.size());
    for (std::size_t k = 0; k < sums.size(); ++k)
        frame.elevations[k] =
            sums[k] > 0 ? static_cast<double>(sums[k]) * unit : std::numeric_limits<double>::quiet_NaN();
    return frame;
}

}  // namespace talus
