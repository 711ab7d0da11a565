#pragma once
#include <vector>

#include "src/setup/release.hpp"
#include "src/setup/shape_reader.hpp"
#include "src/setup/terrain_reader.hpp"

namespace talus {

/// What a [[release]] table says: one release, or one for each polygon of its `areas`. Faults are recorded in
/// the scene. Collective.
std::vector<Release> read_release(const Section& table, const BodyContext& context,
                                  const SceneTerrain& terrain, double first_spacing);

}  // namespace talus
