#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <new>

#include "comm/environment.hpp"
#include "io/file_info.hpp"
#include "io/scene.hpp"
#include "io/units.hpp"
#include "src/run/commands.hpp"

namespace {

using namespace talus;

/// HH:MM:SS, MM:SS or seconds. [s]
double walltime_of(const std::string& text) {
    double seconds = 0;
    std::size_t parts = 0;
    for (std::size_t start = 0; start <= text.size(); ++parts) {
        const std::size_t colon = std::min(text.find(':', start), text.size());
        const std::string part = text.substr(start, colon - start);
        if (part.empty() || part.find_first_not_of("0123456789") != std::string::npos || parts == 3)
            throw CLI::ValidationError("--walltime", "'" + text + "' is not HH:MM:SS");
        seconds = 60 * seconds + std::stod(part);
        start = colon + 1;
    }
    return seconds;
}

struct CommandLine {
    RunOptions run;
    std::string until, walltime;
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
                ->type_name("KEY=VALUE");
        }
        run_command->add_option("--steps", run.steps, "Stop after this many steps in all");
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
        info_command->add_option("file", file)->required();
        hash_command = app.add_subcommand("hash", "One hash of a checkpoint's complete state");
        hash_command->add_option("file", file, "Checkpoint, or folder with checkpoints")->required();
    }

    void finish() {
        if (!walltime.empty()) run.walltime = walltime_of(walltime);
        if (!until.empty()) {
            try {
                run.until = until.find_first_not_of("0123456789.eE+-") == std::string::npos
                                ? std::stod(until)
                                : convert_to_si(until, "s");
            } catch (const std::exception& error) {
                throw CLI::ValidationError("--until", error.what());
            }
        }
    }
};

int dispatch(const Communicator& comm, const CommandLine& line) {
    if (line.run_command->parsed()) return run_scene(comm, line.run);
    if (line.check_command->parsed()) return check_scene(comm, line.run);
    if (line.analyse_command->parsed()) return analyse_checkpoint(comm, line.run);
    if (!comm.is_root()) return exit_done;
    fmt::print("{}\n", line.info_command->parsed() ? describe_file(line.file) : hash_file(line.file));
    return exit_done;
}

}  // namespace

int main(int argc, char** argv) {
    const Environment environment(argc, argv);
    const Communicator comm = world();
    CommandLine line;
    try {
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
