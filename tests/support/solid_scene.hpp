#pragma once
#include <memory>
#include <string>
#include <vector>

#include "src/run/commands.hpp"
#include "src/setup/scene_setup.hpp"

/// Scenes of runs/ as simulations, and their particles on every rank.
namespace talus::test {

/// The scene runs/`name` with overrides, the numbers of particles being those of --quick.
inline SceneSetup solid_scene(const Communicator& comm, const std::string& name,
                              std::vector<std::string> overrides = {}) {
    RunOptions options;
    options.scene = TALUS_SOURCE_DIR "/runs/" + name;
    options.quick = true;
    options.overrides = std::move(overrides);
    const Scene scene = load_scene(comm, options);
    return read_scene(comm, scene);
}

inline std::unique_ptr<Simulation> started(const Communicator& comm, const SceneSetup& scene) {
    auto simulation = std::make_unique<Simulation>(comm, scene.simulation, make_particles(comm, scene));
    simulation->start();
    return simulation;
}

/// One component of a field of all particles; all fields come in the same order. Collective.
template <class T>
std::vector<T> on_every_rank(const Simulation& simulation, const Field<T>& field, int component = 0) {
    return simulation.comm().all_gather(simulation.particles().own(field, component));
}

}  // namespace talus::test
