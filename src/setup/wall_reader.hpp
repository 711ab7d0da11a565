#pragma once
#include <vector>

#include "comm/communicator.hpp"
#include "domain/box.hpp"
#include "io/scene.hpp"
#include "physics/dem/walls/wall.hpp"
#include "src/setup/grain_law_reader.hpp"

namespace talus {

/// What walls are read with.
struct WallContext {
    const Communicator& comm;
    const Scene& scene;
    const Box& box;
    double largest_radius;  ///< of the grains [m]
};

/// The tables [[wall]]. Faults are recorded in the scene; what is wrong with a mesh that can be used all the
/// same is appended to `warnings`. Collective.
std::vector<dem::Wall> read_walls(const WallContext& context, GrainLawReader& laws,
                                  std::vector<std::string>& warnings);

/// Names and kinds of walls in order, as checkpoints hold them.
std::vector<std::string> names_of_walls(const std::vector<dem::Wall>& walls);

/// The table [motion] of a wall in that many dimensions; at rest if it is not there.
dem::WallMotion read_motion(const Section& table, int dimension);

}  // namespace talus
