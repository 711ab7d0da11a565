#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "src/run/commands.hpp"
#include "src/run/recorder.hpp"
#include "src/run/restart.hpp"
#include "src/run/scene_checks.hpp"
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
    double end_time = options.until.value_or(setup.output.end_time);
    if (setup.hand_off) end_time = std::min(end_time, setup.hand_off->at);
    check_plan(scene, setup, end_time);
    const std::filesystem::path folder = output_folder(scene, options);
    StopRequest stop(comm, folder, options.walltime);

    // The folder is touched only once it is known that the run can begin.
    std::optional<Restart> restart;
    if (!options.restart.empty()) restart = read_restart(comm, options.restart, folder, setup);
    ParticleSet particles = restart ? std::move(restart->particles) : make_particles(comm, setup);
    std::vector<Settling> settlings;
    if (!restart)
        settlings = settle(comm, setup, particles, [&] {
            if (const std::string why = stop.reason(0, 0); !why.empty())
                throw AgreedError(exit_stopped_early,
                                  fmt::format("stopped early: {}; the next run settles from the start", why));
        });
    Simulation simulation(comm, setup.simulation, std::move(particles));
    check_box(scene, simulation);
    Recorder recorder(comm, folder, scene, setup, !restart);
    if (restart) {
        recorder.go_on_from(*restart);
        simulation.resume(restart->state.time, restart->state.time_step, restart->state.step,
                          restart->state.numbers.contains("late_phase"));
    } else {
        simulation.start();
        recorder.note(settlings);
    }
    recorder.begin(simulation, end_time);
    try {
        while (!finished(simulation, end_time, options)) {
            if (const std::string why = stop.reason(recorder.longest_step(), recorder.checkpoint_seconds());
                !why.empty()) {
                recorder.stop_early(simulation, why);
                return exit_stopped_early;
            }
            simulation.step();
            recorder.after_step(simulation);
        }
    } catch (const AgreedError& error) {
        throw AgreedError(error.exit_code,
                          fmt::format("{}\n{}", error.what(), recorder.after_failure(simulation)));
    }
    recorder.finish(simulation);
    if (setup.hand_off && simulation.time() >= setup.hand_off->at)
        recorder.hand_over(simulation,
                           hand_off(comm, *setup.hand_off, setup.simulation.box, simulation.particles()));
    return exit_done;
}

}  // namespace talus
