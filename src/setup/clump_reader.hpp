#pragma once
#include "io/scene.hpp"
#include "src/setup/grain_scene.hpp"

namespace talus {

/// Reads the keys `clump` and `orientation` of a body of grains or a source, and the table [clumps.NAME];
/// without a clump if it cannot be used: what is wrong is recorded in the scene.
void read_clump(const Scene& scene, const Section& table, GrainBody& body);

}  // namespace talus
