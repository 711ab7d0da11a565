#pragma once
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace talus {

/// Exit codes of the program; exit_input_output = 3 is io's (io/agree.hpp).
enum ExitCode : int {
    exit_done = 0,
    exit_run_failed = 1,
    exit_bad_scene = 2,
    exit_stopped_early = 75,
};

/// What the command line of `talus run` and `talus check` says.
struct RunOptions {
    std::filesystem::path scene;
    bool quick = false;
    std::optional<std::uint64_t> steps;  ///< stop after this many steps in all
    std::optional<double> until;         ///< stop at this time [s], in place of the scene's end_time
    std::filesystem::path out;           ///< empty: out/<name of the scene>
    std::vector<std::string> overrides;  ///< key=value
    std::string restart;                 ///< empty: new run
    double walltime = std::numeric_limits<double>::infinity();  ///< [s]
};

}  // namespace talus
