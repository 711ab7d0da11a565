#pragma once
#include <map>
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

/// Gives a scene the kernel of Basset's force that the memories in a checkpoint, with the numbers
/// CoupledSimulation::save_numbers(), were made with. Throws SceneError (on every rank) if the checkpoint has
/// none and the scene one or the reverse, if dem.time_step is below the kernel's shortest time, or if the
/// scene names another coupling.basset_memory than its longest.
void take_history_kernel(const Scene& scene, const std::map<std::string, double>& numbers,
                         CoupledScene& coupled);

}  // namespace talus
