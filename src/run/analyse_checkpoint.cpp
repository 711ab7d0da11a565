#include <fmt/format.h>

#include "io/checkpoint.hpp"
#include "src/analysis/analysis.hpp"
#include "src/run/commands.hpp"
#include "src/setup/scene_setup.hpp"

namespace talus {

int analyse_checkpoint(const Communicator& comm, const RunOptions& options) {
    const Scene scene = load_scene(comm, options);
    const SceneSetup setup = read_scene(comm, scene);
    if (!setup.analysis.fragments)
        throw SceneError(
            fmt::format("{}: there is no [analysis] table with fragments = true", scene.file().string()));
    const std::filesystem::path folder = output_folder(scene, options);
    const std::filesystem::path file =
        find_checkpoint(comm, options.restart.empty() ? "latest" : options.restart, folder);
    ParticleSet particles = empty_particles(setup);
    const RunState state = read_checkpoint(comm, file, {&particles});
    const Breakup breakup = analyse(comm, setup.analysis, setup.simulation.box, particles);
    write_breakup(comm, folder, state.time, setup.analysis, breakup);
    if (comm.is_root()) fmt::print("{} (time {} s): {}\n", file.string(), state.time, describe(breakup));
    return exit_done;
}

}  // namespace talus
