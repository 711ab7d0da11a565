#pragma once
#include <memory>
#include <string>

#include "comm/communicator.hpp"
#include "domain/terrain.hpp"
#include "io/scene.hpp"

namespace talus {

/// The ground of a scene and what a raster on it needs.
struct SceneTerrain {
    std::shared_ptr<const Terrain> ground;
    TerrainGrid frame;      ///< points of the ground, without elevations; no rows for a plane
    std::string file;       ///< empty for a plane
    std::string reference;  ///< of its coordinates, as WKT; empty if not known
};

/// Reads `table`: a plane, a `profile` along x, or a raster (`file`) in two dimensions. Faults are recorded
/// in the scene, those of files are AgreedErrors. Collective.
SceneTerrain read_terrain(const Communicator& comm, const Scene& scene, const Section& table, int dimension);

/// Records a fault at `key` if coordinates of a file are others than the terrain's. Collective.
void check_reference(const Communicator& comm, const SceneTerrain& terrain, const Section& table,
                     std::string_view key, const std::string& file, const std::string& reference);

}  // namespace talus
