#pragma once
#include <optional>
#include <string>
#include <vector>

#include "io/scene.hpp"
#include "src/setup/impact.hpp"

namespace talus {

/// The scene's [impact] table, if there is one; keys in docs/scene.md. `names`: those of the bodies. Faults
/// are recorded in the scene.
std::optional<ImpactPlan> read_impact(const Section& root, const std::vector<std::string>& names,
                                      int dimension);

}  // namespace talus
