#pragma once
#include <string>
#include <vector>

#include "comm/communicator.hpp"
#include "io/scene.hpp"
#include "src/coupled_simulation.hpp"
#include "src/setup/grain_scene.hpp"
#include "src/setup/water_scene.hpp"

namespace talus {

/// A scene of water and grains that act on each other, read and checked.
struct CoupledScene {
    WaterScene water;
    GrainScene grains;
    CouplingSetup coupling;
    double kernel_radius = 0;      ///< of the water [m]
    double greatest_diameter = 0;  ///< of the grains [m]
    std::vector<std::string> warnings{};

    /// With grains that have settled, if they shall.
    CoupledSetup simulation() const {
        GrainSetup settled = grains.simulation;
        settled.settling.reset();
        return {water.simulation, settled, coupling};
    }
};

/// Whether the scene is one of both: it has a table [water] and [[grains]].
bool is_coupled_scene(const Scene& scene);

/// Reads everything such a scene says. Throws SceneError (on every rank) with all faults at once. Collective.
CoupledScene read_coupled_scene(const Communicator& comm, const Scene& scene);

}  // namespace talus
