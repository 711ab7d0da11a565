#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "comm/communicator.hpp"
#include "domain/particles.hpp"
#include "domain/terrain.hpp"

namespace talus {

/// One column of a flow over the map.
struct MapColumn {
    std::array<double, 2> place;  ///< [m]
    double area;                  ///< in plan [m2]
    double depth;                 ///< [m]
    double speed;                 ///< [m/s]
};

/// What the cells of a raster keep of a flow: the greatest depth and speed and the time of arrival. A column
/// covers the cell that it is in and those whose centres lie in a disc around it, large enough that columns
/// on a lattice of squares leave no gap. Only minima and maxima are kept, so that neither the order of
/// columns nor their ranks matter.
class FlowRecord {
  public:
    /// Cells at the points of `frame`, whose elevations are not used. The flow has arrived where it is deeper
    /// than `threshold` [m]; columns that are not count for nothing.
    FlowRecord(TerrainGrid frame, double threshold);

    /// Adds the columns of this rank at a time [s].
    void add(const MapColumn& column, double time);

    /// Brings what all ranks know to every rank. Collective.
    void share(const Communicator& comm);

    /// A field of the cells, NaN where the flow has not been, row by row from the south. After share().
    TerrainGrid depths() const { return grid_of(&Cell::depth); }
    TerrainGrid speeds() const { return grid_of(&Cell::speed); }
    TerrainGrid arrivals() const { return grid_of(&Cell::arrival); }

    const TerrainGrid& frame() const { return frame_; }
    std::size_t bytes() const { return cells_.size() * sizeof(Cell); }

    /// Cells where the flow has been, as rows of a set for a checkpoint: a share of them on each rank. Shares
    /// first. Collective.
    ParticleSet save(const Communicator& comm);
    static ParticleSet empty_set();
    /// Goes on from the rows of a checkpoint, on any ranks. Throws AgreedError (exit code 2) if they are of
    /// other cells. Collective.
    void restore(const Communicator& comm, const ParticleSet& cells);

  private:
    struct Cell {
        float depth = 0, speed = 0, arrival = std::numeric_limits<float>::infinity();
    };

    std::array<double, 2> place_of(std::uint64_t index) const {
        return {frame_.origin[0] + frame_.spacing[0] * static_cast<double>(index % frame_.columns),
                frame_.origin[1] + frame_.spacing[1] * static_cast<double>(index / frame_.columns)};
    }
    TerrainGrid grid_of(float Cell::*what) const;
    void mark(Cell& cell, const MapColumn& column, double time) const;

    TerrainGrid frame_;
    double threshold_;
    std::vector<Cell> cells_;
};

/// The depths of columns on a raster that keeps their volume: every column is spread over the cells around it
/// by `share`, a falling function of the distance over `reach`, and rounded to units of 2^-40 m, so that sums
/// have the same bits in any order. Collective.
struct SpreadColumn {
    std::array<double, 2> place;  ///< [m]
    double volume;                ///< depth times area in plan [m3]
    double reach;                 ///< [m]
};
TerrainGrid spread_depths(const Communicator& comm, TerrainGrid frame,
                          const std::vector<SpreadColumn>& columns);

}  // namespace talus
