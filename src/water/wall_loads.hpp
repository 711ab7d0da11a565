#pragma once
#include <vector>

#include "physics/dem/vector3.hpp"
#include "src/water_simulation.hpp"

namespace talus {

/// Of the water on a wall.
struct WallLoad {
    dem::Vector3<> force;   ///< [N], in 2D for each metre across
    dem::Vector3<> torque;  ///< about the centre of the wall's motion, carried along [N m]
};

/// Of each wall whose forces are recorded, in order of the bodies, as the water felt it at the last
/// evaluation; zero before the first. Exact sums, the same bits on any number of ranks. Collective.
std::vector<WallLoad> wall_loads(WaterSimulation& simulation);

}  // namespace talus
