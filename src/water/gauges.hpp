#pragma once
#include <array>
#include <span>
#include <string>
#include <vector>

#include "src/setup/point.hpp"
#include "src/water_simulation.hpp"

namespace talus {

/// A place where water is measured.
struct WaterGauge {
    std::string name;
    Point place{};  ///< [m]
};

/// What a gauge shows; zeros in the dry, but for the level.
struct WaterReading {
    /// Mean of the water within the kernel's reach, each particle's carried to the gauge as at rest: p + rho
    /// g . (x - x_j), as walls have it [Pa].
    double pressure = 0;
    std::array<double, 3> velocity{};  ///< mean of the same water [m/s]
    /// Height against gravity of the highest place straight above the gauge with half as much water around
    /// it as where there is most; that of the gauge if there is none [m].
    double level = 0;
};

/// Readings of all gauges, the same bits on any number of ranks. Collective.
std::vector<WaterReading> read_gauges(const WaterSimulation& simulation, std::span<const WaterGauge> gauges);

}  // namespace talus
