#pragma once
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "domain/terrain.hpp"
#include "src/depth/flow_record.hpp"
#include "src/depth_simulation.hpp"

namespace talus {

/// Rasters that a run leaves.
struct ResultsPlan {
    TerrainGrid frame;       ///< whose cells they have; no rows if none are wanted
    std::string reference;   ///< of the coordinates, as WKT
    double threshold = 0;    ///< depth from which on the flow has arrived [m]
    bool is_geotiff = true;  ///< else ESRI ASCII grids
};

/// A place where depth and level are watched.
struct Gauge {
    std::string name;
    std::array<double, 2> place;  ///< [m]
};

/// What a gauge shows: the level of the columns around, weighed by kernel and volume, where those cover at
/// least a tenth of its surroundings; else it is dry, and its level is that of the ground.
struct GaugeReading {
    double depth, level;  ///< [m]
};

/// Adds a simulation's columns of this rank, as they are now.
void add_columns(FlowRecord& record, const DepthSimulation& simulation);

/// Writes the ground, greatest depth, speed and pressure (density times the square of the greatest speed),
/// time of arrival and the depth now to `folder`/results, and returns what to log. The record must be shared.
/// Collective.
std::string write_results(const DepthSimulation& simulation, const FlowRecord& record,
                          const ResultsPlan& plan, const std::filesystem::path& folder);

/// Same bits on any ranks. Collective.
std::vector<GaugeReading> read_gauges(const DepthSimulation& simulation, const std::vector<Gauge>& gauges);

}  // namespace talus
