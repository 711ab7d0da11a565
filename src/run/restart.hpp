#pragma once
#include <filesystem>
#include <string>

#include "comm/communicator.hpp"
#include "domain/particles.hpp"
#include "io/run_state.hpp"
#include "src/setup/scene_setup.hpp"

namespace talus {

/// What a run goes on from.
struct Restart {
    std::filesystem::path file;
    RunState state;
    ParticleSet particles;  ///< each rank its share, not yet where they belong
    double seconds = 0;     ///< wall time of reading [s]
};

/// Reads the checkpoint that `what` means (see find_checkpoint()) for a scene. Throws AgreedError (exit code
/// 3) if there is none, if it is damaged, or if it holds other bodies than the scene: their number and the
/// names of their materials must be the same. Collective.
Restart read_restart(const Communicator& comm, const std::filesystem::path& what,
                     const std::filesystem::path& output_folder, const SceneSetup& setup);

}  // namespace talus
