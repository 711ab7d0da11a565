#pragma once
#include <vector>

#include "io/scene.hpp"
#include "physics/dem/bonds/bond_list.hpp"
#include "src/setup/grain_law_reader.hpp"
#include "src/setup/grain_scene.hpp"

namespace talus {

/// Reads the tables [[bond]]. Faults are recorded in the scene.
std::vector<dem::BondRule> read_bonds(const Section& root, const std::vector<GrainBody>& bodies);

/// The usual step where none is asked for: no more than 0.3 of the stable one of grains with twelve bonds
/// each [s]. What bonds there are is only known with the grains.
double usual_step_of_bonds(const std::vector<dem::BondRule>& rules, const std::vector<GrainBody>& bodies);

}  // namespace talus
