#pragma once
#include <vector>

#include "domain/box.hpp"
#include "io/scene.hpp"
#include "physics/dem/walls/wall.hpp"
#include "src/setup/grain_law_reader.hpp"

namespace talus {

/// The tables [[wall]]. Faults are recorded in the scene.
std::vector<dem::Wall> read_walls(const Scene& scene, const Box& box, GrainLawReader& laws);

}  // namespace talus
