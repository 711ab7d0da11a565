#pragma once
#include <cstdint>

#include "src/water_simulation.hpp"

namespace talus {

/// Water that is near particles of walls.
struct WallGap {
    double least;  ///< distance of a particle of water to one of a wall, `searched` if none is nearer [m]
    std::uint64_t within;  ///< particles of water that are nearer to one than `searched`
};

/// As they were at the last evaluation; `searched`: at most as far as the kernel reaches [m]. Collective.
WallGap find_wall_gap(const WaterSimulation& simulation, double searched);

}  // namespace talus
