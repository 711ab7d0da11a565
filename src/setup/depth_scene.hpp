#pragma once
#include <string>
#include <vector>

#include "comm/communicator.hpp"
#include "io/scene.hpp"
#include "src/depth/flow_map.hpp"
#include "src/depth_simulation.hpp"
#include "src/setup/release.hpp"
#include "src/setup/scene_setup.hpp"

namespace talus {

/// A depth-integrated scene, read and checked.
struct DepthScene {
    std::string title;
    DepthSetup simulation;
    std::vector<Release> releases;
    OutputPlan output;
    ResultsPlan results;
    std::vector<Gauge> gauges;
    std::vector<std::string> notes;  ///< what a user should know of the releases
};

/// Whether a scene describes a depth-integrated flow.
bool is_depth_scene(const Scene& scene);

/// Reads everything a scene says. Throws SceneError (on every rank) with all faults at once. Collective.
DepthScene read_depth_scene(const Communicator& comm, const Scene& scene);

/// An empty set with the fields the scene's models need.
ParticleSet empty_columns(const DepthSetup& setup);

/// The scene's particles at time 0, each rank its share. Collective.
ParticleSet make_columns(const Communicator& comm, const DepthScene& scene);

}  // namespace talus
