#pragma once
#include <vector>

#include "tests/support/grain_scene.hpp"

namespace talus::test {

/// Equal smooth grains of diameter 1 and mass 1 in a cubic box that is periodic along all axes: what lengths,
/// masses and times are counted in. The linear law gives every collision the same duration and restitution.
struct GranularGas {
    std::size_t grains_along_edge;  ///< at the start, on a cubic lattice
    double volume_fraction;         ///< [1]
    double restitution;             ///< [1]
    double contact_time;            ///< duration of a collision

    double edge() const;       ///< of the box
    double number() const;     ///< grains
    double stiffness() const;  ///< of the spring between grains
    double damping() const;    ///< force of their dashpot over the speed of approach
    GrainSetup setup() const;
    /// At rest on the lattice.
    std::vector<GrainState> lattice() const;
};

/// Random velocities, evenly distributed in a cube, without momentum and with the mean square 3
/// `temperature`.
void heat(std::vector<GrainState>& grains, double temperature);

}  // namespace talus::test
