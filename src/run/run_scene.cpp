#include <fmt/format.h>

#include <optional>

#include "src/run/commands.hpp"
#include "src/run/evolution.hpp"
#include "src/run/recorder.hpp"
#include "src/run/stop_request.hpp"

namespace talus {

namespace {

bool finished(const Evolution& evolution, double end_time, const RunOptions& options) {
    if (options.steps && evolution.step_count() >= *options.steps) return true;
    return evolution.time() >= end_time;
}

}  // namespace

int run_scene(const Communicator& comm, const RunOptions& options) {
    const Scene scene = load_scene(comm, options);
    const std::unique_ptr<Evolution> evolution = read_evolution(comm, scene, options.until);
    const double end_time = evolution->end_time();
    const std::filesystem::path folder = output_folder(scene, options);
    StopRequest stop(comm, folder, options.walltime);

    // The folder is touched only once it is known that the run can begin.
    std::optional<ReadCheckpoint> restart;
    if (options.restart.empty())
        evolution->create([&] {
            if (const std::string why = stop.reason(0, 0); !why.empty())
                throw AgreedError(
                    1, fmt::format("stopped early: {}; no checkpoint holds a body that settles, the "
                                   "next run begins with it again",
                                   why));
        });
    else
        restart = evolution->read(options.restart, folder);
    Recorder recorder(comm, folder, scene, evolution->output(), !restart);
    if (restart) {
        recorder.go_on_from(*restart);
        evolution->resume(restart->state);
    } else {
        evolution->start();
    }
    recorder.begin(*evolution, end_time);
    try {
        while (!finished(*evolution, end_time, options)) {
            if (const std::string why = stop.reason(recorder.longest_step(), recorder.checkpoint_seconds());
                !why.empty()) {
                recorder.stop_early(*evolution, why);
                return exit_stopped_early;
            }
            evolution->step();
            recorder.after_step(*evolution);
        }
    } catch (const AgreedError& error) {
        throw AgreedError(error.exit_code,
                          fmt::format("{}\n{}", error.what(), recorder.after_failure(*evolution)));
    }
    recorder.finish(*evolution);
    recorder.hand_over(*evolution);
    return exit_done;
}

}  // namespace talus
