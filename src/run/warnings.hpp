#pragma once
#include <string>
#include <vector>

#include "src/setup/scene_setup.hpp"

namespace talus {

/// What a user should know before the first step: choices that are known to fail somewhere, each with its
/// number and its remedy. Scans the (density, energy) plane of every Tillotson equation of state for c^2 < 0
/// (a few milliseconds).
std::vector<std::string> warnings(const SceneSetup& setup);

}  // namespace talus
