#pragma once
#include <memory>

#include "io/scene.hpp"
#include "physics/dem/clumps/clump_shape.hpp"

namespace talus {

/// The table [clumps.NAME] that a body of grains names by its key `clump`: the spheres' places `x`, `y`, `z`
/// and `radii`. Null if it has a fault, which is recorded in the scene.
std::shared_ptr<const dem::ClumpShape> read_clump(const Scene& scene, const Section& body);

}  // namespace talus
