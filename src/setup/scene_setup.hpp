#pragma once
#include <string>
#include <vector>

#include "comm/communicator.hpp"
#include "io/scene.hpp"
#include "src/analysis/analysis.hpp"
#include "src/analysis/hand_off.hpp"
#include "src/setup/impact.hpp"
#include "src/setup/settle.hpp"
#include "src/simulation.hpp"

namespace talus {

/// What a run writes and when it ends; the scene's [run] and [output] tables.
struct OutputPlan {
    double end_time = 0;              ///< [s]
    double snapshot_interval = 0;     ///< [s]; 0: only the first and the last state
    double diagnostics_interval = 0;  ///< [s]; 0: every step
    double checkpoint_interval = 0;   ///< wall time [s]; 0: only at the end and when asked to stop
    std::vector<std::string> fields;  ///< extra fields in snapshots
};

/// A scene, read and checked.
struct SceneSetup {
    std::string title;
    Setup simulation;
    std::vector<Body> bodies;
    std::vector<BodyCensus> census;                   ///< one a body, of the bodies as they were read
    std::optional<Impact> impact;                     ///< as the scene's [impact] table asks
    std::optional<SettlePlan> settle;                 ///< none: the bodies start as they are made
    double gravitational_constant = newton_constant;  ///< that of [gravity], if given [m3 kg-1 s-2]
    OutputPlan output;
    AnalysisPlan analysis;
    std::optional<HandOffPlan> hand_off;  ///< none: the run is SPH to its end
    std::uint64_t seed = 0;
};

/// Reads everything a scene says. Throws SceneError (on every rank) with all faults at once. Collective.
SceneSetup read_scene(const Communicator& comm, const Scene& scene);

/// An empty set with the fields the scene's models need.
ParticleSet empty_particles(const SceneSetup& setup);

/// The scene's particles at time 0, before they settle. Collective.
ParticleSet make_particles(const Communicator& comm, const SceneSetup& setup);

}  // namespace talus
