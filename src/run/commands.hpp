#pragma once
#include <filesystem>

#include "comm/communicator.hpp"
#include "io/scene.hpp"
#include "src/run/options.hpp"

namespace talus {

/// `talus run`: runs a scene to its end, or until asked to stop. Returns the exit code. Throws SceneError for
/// a bad scene and AgreedError for everything that goes wrong later. Collective.
int run_scene(const Communicator& comm, const RunOptions& options);

/// `talus check`: reads and validates a scene and prints what it resolves to, particle counts, bytes per
/// particle and per rank, the first time step and the estimated cost. Collective.
int check_scene(const Communicator& comm, const RunOptions& options);

/// `talus analyse`: what the scene's [analysis] table asks for, of a checkpoint in the run's output folder
/// (the newest, or --restart); written there. Collective.
int analyse_checkpoint(const Communicator& comm, const RunOptions& options);

/// Where a run's results go: --out, or out/<name of the scene>.
std::filesystem::path output_folder(const Scene& scene, const RunOptions& options);

/// The scene that the options name, with --quick and --set applied. Collective.
Scene load_scene(const Communicator& comm, const RunOptions& options);

}  // namespace talus
