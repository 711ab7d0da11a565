#include <fmt/format.h>

#include "src/run/commands.hpp"
#include "src/run/recorder.hpp"
#include "src/run/stop_request.hpp"
#include "src/setup/scene_setup.hpp"

namespace talus {

namespace {

bool finished(const Simulation& simulation, double end_time, const RunOptions& options) {
    if (options.steps && simulation.step_count() >= *options.steps) return true;
    return simulation.time() >= end_time;
}

}  // namespace

int run_scene(const Communicator& comm, const RunOptions& options) {
    const Scene scene = load_scene(comm, options);
    const SceneSetup setup = read_scene(comm, scene);
    const double end_time = options.until.value_or(setup.output.end_time);
    const bool is_new = options.restart.empty();
    Recorder recorder(comm, output_folder(scene, options), scene, setup, is_new);
    StopRequest stop(comm, recorder.folder(), options.walltime);

    std::unique_ptr<Simulation> simulation;
    if (is_new) {
        simulation = std::make_unique<Simulation>(comm, setup.simulation, make_particles(comm, setup));
        simulation->start();
        recorder.begin(*simulation, end_time);
    } else {
        simulation = recorder.restore(options.restart);
        recorder.begin(*simulation, end_time);
    }
    try {
        while (!finished(*simulation, end_time, options)) {
            if (const std::string why = stop.reason(recorder.longest_step()); !why.empty()) {
                recorder.stop_early(*simulation, why);
                return exit_stopped_early;
            }
            simulation->step();
            recorder.after_step(*simulation);
        }
    } catch (const AgreedError& error) {
        throw AgreedError(error.exit_code,
                          fmt::format("{}\n{}", error.what(), recorder.after_failure(*simulation)));
    }
    recorder.finish(*simulation);
    return exit_done;
}

}  // namespace talus
