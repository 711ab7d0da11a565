#pragma once
#include <string>
#include <vector>

#include "src/setup/scene_setup.hpp"

namespace talus {

/// What a user should know before the first step: choices that are known to fail somewhere, each with its
/// number and its remedy. Scans the (density, energy) plane of every Tillotson equation of state for c^2 < 0
/// (a few milliseconds).
std::vector<std::string> warnings(const SceneSetup& setup);

/// Adds a note if a wall of particles is thinner than forces reach, `range` [m]: matter near it misses
/// partners.
void warn_of_thin_wall(const Body& wall, double range, int dimension, std::vector<std::string>& found);

}  // namespace talus
