#pragma once
#include <vector>

#include "io/scene.hpp"
#include "src/depth/flow_map.hpp"
#include "src/setup/terrain_reader.hpp"

namespace talus {

/// What [results] asks for: rasters with the cells of the terrain's, or cells that the table gives. Faults
/// are recorded in the scene.
ResultsPlan read_results(const Section& root, const SceneTerrain& terrain, int dimension);

/// The [[gauge]]s of a scene. Faults are recorded in the scene.
std::vector<Gauge> read_gauge_places(const Section& root, const Terrain& terrain, int dimension);

}  // namespace talus
