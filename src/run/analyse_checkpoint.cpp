#include <fmt/format.h>

#include "src/analysis/analysis.hpp"
#include "src/run/commands.hpp"
#include "src/run/restart.hpp"
#include "src/setup/scene_setup.hpp"

namespace talus {

int analyse_checkpoint(const Communicator& comm, const RunOptions& options) {
    const Scene scene = load_scene(comm, options);
    const SceneSetup setup = read_scene(comm, scene);
    if (!setup.analysis.asks_for_anything())
        throw SceneError(fmt::format("{}: there is no [analysis] table with fragments or remnants = true",
                                     scene.file().string()));
    const std::filesystem::path folder = output_folder(scene, options);
    const Restart found =
        read_restart(comm, options.restart.empty() ? "latest" : options.restart, folder, setup);
    const Breakup breakup = analyse(comm, setup.analysis, setup.simulation.box, found.particles);
    write_breakup(comm, folder, found.state, setup.analysis, breakup);
    if (comm.is_root())
        fmt::print("{} (time {} s): {}\n", found.file.string(), found.state.time,
                   describe(setup.analysis, breakup));
    return exit_done;
}

}  // namespace talus
