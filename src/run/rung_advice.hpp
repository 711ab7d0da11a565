#pragma once
#include <string>

#include "src/setup/depth_scene.hpp"

namespace talus {

/// The cheapest model that tells what a depth-integrated scene asks, with the reason and its cost: a block,
/// less than the scene's own models, the scene as it is, or a continuum. The rules and where they come from
/// are in docs/landslides.md. `start`: totals at time 0.
std::string rung_advice(const DepthScene& scene, const DepthTotals& start);

}  // namespace talus
