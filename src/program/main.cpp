#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <new>
#include <optional>
#include <set>
#include <string_view>

#include "comm/environment.hpp"
#include "io/agree.hpp"
#include "io/file_info.hpp"
#include "io/scene.hpp"
#include "io/spelling.hpp"
#include "io/units.hpp"
#include "src/run/commands.hpp"

namespace {

using namespace talus;

/// A number that is all of a text; nothing if it is none or out of range.
template <class Number>
std::optional<Number> number_of(std::string_view text) {
    Number number{};
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (failure != std::errc() || end != text.data() + text.size()) return {};
    return number;
}

/// HH:MM:SS, MM:SS or seconds. [s]
double walltime_of(const std::string& text) {
    double seconds = 0;
    std::size_t parts = 0;
    for (std::size_t start = 0; start <= text.size(); ++parts) {
        const std::size_t colon = std::min(text.find(':', start), text.size());
        const auto part = number_of<std::uint32_t>(std::string_view(text).substr(start, colon - start));
        if (!part || parts == 3) throw CLI::ValidationError("--walltime", "'" + text + "' is not HH:MM:SS");
        seconds = 60 * seconds + *part;
        start = colon + 1;
    }
    return seconds;
}

/// Seconds, or a number with a unit of time; positive and finite. [s]
double end_time_of(const std::string& text) {
    double time = 0;
    try {
        const std::optional<double> seconds = number_of<double>(text);
        time = seconds ? *seconds : convert_to_si(text, "s");
    } catch (const UnitError& error) {
        throw CLI::ValidationError("--until", error.what());
    }
    if (!(time > 0) || !std::isfinite(time))
        throw CLI::ValidationError("--until", "'" + text + "' is not a time; allowed: more than 0 s");
    return time;
}

/// An error if the first word is none of the program's commands.
void check_command(CLI::App& app, int argc, char** argv) {
    if (argc < 2 || argv[1][0] == '-') return;
    std::set<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        names.insert(command->get_name());
    if (names.contains(argv[1])) return;
    const std::string nearest = nearest_spelling(argv[1], names);
    throw CLI::ValidationError(
        argv[1], fmt::format("is not a command; {}", nearest.empty()
                                                         ? fmt::format("allowed: {}", fmt::join(names, ", "))
                                                         : fmt::format("did you mean {}?", nearest)));
}

struct CommandLine {
    RunOptions run;
    std::optional<std::string> until, walltime;
    std::filesystem::path file;
    CLI::App app{"Talus: particles of rock, soil, grains and water, on any number of MPI ranks", "talus"};
    CLI::App *run_command, *check_command, *analyse_command, *info_command, *hash_command;

    CommandLine() {
        app.set_version_flag("--version", std::string("talus ") + TALUS_VERSION);
        app.require_subcommand(1);
        run_command = app.add_subcommand("run", "Run a scene");
        check_command = app.add_subcommand("check", "Read and validate a scene; say what it would cost");
        analyse_command =
            app.add_subcommand("analyse", "Find the fragments in the newest checkpoint of a scene's run");
        for (CLI::App* command : {run_command, check_command, analyse_command}) {
            command->add_option("scene", run.scene, "TOML file, or folder with a scene.toml")->required();
            command->add_flag("--quick", run.quick, "Use the scene's [quick] values: ends in seconds");
            command->add_option("--set", run.overrides, "Override a key: --set body[0].radius='2 cm'")
                ->take_all()
                ->allow_extra_args(false)  // one value each: what follows may be the scene
                ->type_name("KEY=VALUE");
        }
        run_command->add_option("--steps", run.steps, "Stop after this many steps in all")
            ->check([](const std::string& text) {
                return number_of<std::uint64_t>(text) ? "" : "'" + text + "' is not a number of steps";
            });
        run_command->add_option("--until", until, "Stop at this time: seconds, or a number with a unit");
        for (CLI::App* command : {run_command, analyse_command}) {
            command->add_option("--out", run.out, "Folder for results (default out/<scene>)");
            command->add_option("--restart", run.restart,
                                "Start from a checkpoint: a file, a folder or 'latest'");
        }
        run_command
            ->add_option("--walltime", walltime, "Write a checkpoint and stop before this much wall time")
            ->type_name("HH:MM:SS");
        info_command = app.add_subcommand("info", "Say what is in a checkpoint or snapshot");
        info_command->add_option("file", file, "Checkpoint or snapshot, or folder with checkpoints")
            ->required();
        hash_command = app.add_subcommand("hash", "One hash of a checkpoint's complete state");
        hash_command->add_option("file", file, "Checkpoint, or folder with checkpoints")->required();
    }

    void finish() {
        if (walltime) run.walltime = walltime_of(*walltime);
        if (until) run.until = end_time_of(*until);
    }
};

int dispatch(const Communicator& comm, const CommandLine& line) {
    if (line.run_command->parsed()) return run_scene(comm, line.run);
    if (line.check_command->parsed()) return check_scene(comm, line.run);
    if (line.analyse_command->parsed()) return analyse_checkpoint(comm, line.run);
    if (!comm.is_root()) return exit_done;
    if (line.hash_command->parsed()) {
        fmt::print("{}\n", hash_file(line.file));
        return exit_done;
    }
    const FileDescription description = describe_file(line.file);
    fmt::print("{}\n", description.text);
    return description.intact ? exit_done : exit_input_output;
}

/// What the command line asks for, and its exit code.
int run(const Communicator& comm, int argc, char** argv) {
    CommandLine line;
    try {
        check_command(line.app, argc, argv);
        line.app.parse(argc, argv);
        line.finish();
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return comm.is_root() ? line.app.exit(error) : exit_done;
        if (comm.is_root()) fmt::print(stderr, "talus: {}\nSee talus --help.\n", error.what());
        return exit_bad_scene;
    }
    try {
        return dispatch(comm, line);
    } catch (const SceneError& error) {  // every rank has read the same scene
        if (comm.is_root()) fmt::print(stderr, "{}\n", error.what());
        return exit_bad_scene;
    } catch (const AgreedError& error) {
        if (comm.is_root()) fmt::print(stderr, "talus: {}\n", error.what());
        return error.exit_code;
    } catch (const std::bad_alloc&) {  // this rank alone: the others cannot know
        fmt::print(stderr, "talus: rank {} ran out of memory\n", comm.rank());
    } catch (const std::exception& error) {
        fmt::print(stderr, "talus: rank {}: {}\n", comm.rank(), error.what());
    }
    Environment::abort(exit_run_failed);
}

}  // namespace

int main(int argc, char** argv) {
    const Environment environment(argc, argv);
    const Communicator comm = world();
    const int code = run(comm, argc, argv);
    if (files_are_stuck()) Environment::leave(code);
    return code;
}
