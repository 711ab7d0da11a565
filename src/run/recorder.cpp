#include "src/run/recorder.hpp"

#include <fmt/format.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "io/agree.hpp"
#include "io/checkpoint.hpp"
#include "io/csv.hpp"
#include "io/progress.hpp"
#include "io/snapshot.hpp"
#include "src/run/performance_log.hpp"

namespace talus {

namespace {

/// Whether an output that is due every `interval` fell due between two times; every call if it is 0.
bool fell_due(double before, double now, double interval) {
    return interval <= 0 || std::floor(now / interval) > std::floor(before / interval);
}

RunState run_state(const Evolution& evolution, const Scene& scene) {
    RunState state;
    state.time = evolution.time();
    state.time_step = evolution.time_step();
    state.step = evolution.step_count();
    state.scene_text = scene.text();
    state.resolved_scene = scene.resolved();
    state.version = TALUS_VERSION;
    evolution.describe(state);
    return state;
}

bool holds_results(const std::filesystem::path& folder) {
    std::error_code unreadable;
    return std::filesystem::exists(folder / "diagnostics.csv", unreadable) ||
           !list_checkpoints(folder).empty();
}

bool is_within(const std::filesystem::path& path, const std::filesystem::path& folder) {
    const std::filesystem::path relative =
        std::filesystem::canonical(path).lexically_relative(std::filesystem::canonical(folder));
    return !relative.empty() && *relative.begin() != "..";
}

/// Moves a folder with results to the first free name among folder.1, folder.2, ...; returns that name.
/// Throws if that would move the working folder or the scene.
std::filesystem::path set_aside(const std::filesystem::path& folder, const std::filesystem::path& scene) {
    const auto refuse = [&](std::string_view why) {
        throw std::runtime_error(fmt::format(
            "{}: holds the results of an earlier run and {}; move them away or name another --out",
            folder.string(), why));
    };
    if (is_within(std::filesystem::current_path(), folder)) refuse("is the working folder");
    if (is_within(scene, folder)) refuse("the scene");
    for (int n = 1;; ++n) {
        std::filesystem::path aside = folder;
        aside += fmt::format(".{}", n);
        if (std::filesystem::exists(aside)) continue;
        std::error_code failure;
        std::filesystem::rename(folder, aside, failure);
        if (failure) refuse(fmt::format("cannot be renamed to {} ({})", aside.string(), failure.message()));
        return aside;
    }
}

}  // namespace

struct Recorder::Files {
    std::shared_ptr<spdlog::logger> log;
    std::unique_ptr<CsvWriter> diagnostics;
    std::unique_ptr<PerformanceLog> performance;
    std::unique_ptr<Progress> progress;
};

Recorder::Recorder(const Communicator& comm, std::filesystem::path folder, const Scene& scene,
                   const OutputPlan& output, bool is_new)
    : comm_(comm),
      folder_(std::move(folder)),
      scene_(scene),
      output_(output),
      is_new_(is_new),
      files_(std::make_unique<Files>()) {
    agree_on_root(comm_, [&] {
        std::filesystem::path aside;
        if (is_new_ && holds_results(folder_)) aside = set_aside(folder_, scene_.file());
        std::filesystem::create_directories(folder_);
        const auto console = std::make_shared<spdlog::sinks::stdout_color_sink_mt>();
        const auto file = std::make_shared<spdlog::sinks::basic_file_sink_mt>((folder_ / "log.txt").string());
        file->set_pattern("%Y-%m-%d %H:%M:%S %v");
        console->set_pattern("%v");
        files_->log = std::make_shared<spdlog::logger>("talus", spdlog::sinks_init_list{console, file});
        files_->log->flush_on(spdlog::level::info);
        if (!aside.empty()) files_->log->info("results of an earlier run moved to {}", aside.string());
    });
}

Recorder::~Recorder() = default;

void Recorder::go_on_from(const ReadCheckpoint& restart) {
    last_checkpoint_ = restart.file;
    checkpoint_seconds_ = restart.seconds;
    if (!comm_.is_root()) return;
    files_->log->info("going on from {} (step {}, time {} s)", restart.file.string(), restart.state.step,
                      restart.state.time);
    if (restart.state.resolved_scene != scene_.resolved())
        files_->log->warn("the scene differs from the one that wrote this checkpoint");
}

void Recorder::begin(Evolution& evolution, double end_time) {
    first_step_ = evolution.step_count();
    time_before_ = evolution.time();
    if (comm_.is_root()) {
        files_->log->info("{}", evolution.title());
        files_->log->info(
            "{} particles on {} ranks, {} bytes per particle in fields, first step {:.4g} s, results in {}",
            evolution.total_particles(), comm_.size(), evolution.particles().bytes_per_particle(),
            evolution.time_step(), folder_.string());
    }
    if (comm_.is_root()) {
        if (is_new_)
            for (const std::string& note : evolution.preparations()) files_->log->info("{}", note);
        for (const std::string& warning : evolution.warnings()) files_->log->warn("note: {}", warning);
    }
    tell_news(evolution);
    const std::optional<std::uint64_t> restart_step =
        is_new_ ? std::nullopt : std::optional<std::uint64_t>(evolution.step_count());
    files_->diagnostics = std::make_unique<CsvWriter>(comm_, folder_ / "diagnostics.csv",
                                                      evolution.diagnostics_columns(), restart_step);
    files_->performance = std::make_unique<PerformanceLog>(comm_, folder_, restart_step);
    if (is_new_) {
        write_diagnostics(evolution);
        write_snapshot_now(evolution, 0);
        write_checkpoint_now(evolution);
    }
    files_->progress = std::make_unique<Progress>(comm_.is_root(), Progress::Goal{end_time, {}});
    evolution.reset_counters();
    files_->performance->begin(evolution);
    began_ = step_began_ = last_checkpoint_time_ = std::chrono::steady_clock::now();
}

void Recorder::after_step(Evolution& evolution) {
    const double time = evolution.time();
    evolution.phases().enter(Phase::output);
    tell_news(evolution);
    if (fell_due(time_before_, time, output_.diagnostics_interval)) {
        write_diagnostics(evolution);
        files_->performance->write(evolution);
    }
    if (const double interval = output_.snapshot_interval;
        interval > 0 && time >= 0 && fell_due(time_before_, time, interval))
        write_snapshot_now(evolution, static_cast<std::uint64_t>(time / interval));
    const auto now = std::chrono::steady_clock::now();
    if (output_.checkpoint_interval > 0) {
        const std::chrono::duration<double> since = now - last_checkpoint_time_;
        if (comm_.all_max(static_cast<int>(since.count() > output_.checkpoint_interval)))
            write_checkpoint_now(evolution);
    }
    files_->progress->update(evolution.step_count(), time, evolution.time_step(),
                             evolution.total_particles());
    evolution.phases().stop();
    time_before_ = time;
    longest_step_ = std::max(longest_step_, std::chrono::duration<double>(now - step_began_).count());
    step_began_ = std::chrono::steady_clock::now();
}

void Recorder::tell_news(Evolution& evolution) {
    for (const std::string& news : evolution.news())
        if (comm_.is_root()) files_->log->warn("note: step {}: {}", evolution.step_count(), news);
}

void Recorder::stop_early(Evolution& evolution, const std::string& why) {
    files_->progress->finish();
    const std::string summary = evolution.summary();  // of the forces of the last step
    write_checkpoint_now(evolution);
    if (comm_.is_root())
        files_->log->info("stopped early: {}; go on with --restart latest (step {}, time {} s)", why,
                          evolution.step_count(), evolution.time());
    print_summary(evolution, summary);
}

void Recorder::finish(Evolution& evolution) {
    files_->progress->finish();
    if (!is_new_ && evolution.step_count() == first_step_) {
        // What is there is complete; work fields, which snapshots hold, have no values before a step.
        if (comm_.is_root())
            files_->log->info("nothing left to do at step {}, time {} s", first_step_, evolution.time());
        write_analysis(evolution);
        return;
    }
    const std::string summary = evolution.summary();  // of the forces of the last step
    write_checkpoint_now(evolution);
    if (last_snapshot_step_ != evolution.step_count()) {  // the last state, due or not
        const double interval = output_.snapshot_interval;
        write_snapshot_now(
            evolution,
            1 + (interval > 0 ? static_cast<std::uint64_t>(std::max(evolution.time(), 0.0) / interval) : 0));
    }
    write_analysis(evolution);
    print_summary(evolution, summary);
}

void Recorder::hand_over(const Evolution& evolution) {
    const std::string result = evolution.hand_over(folder_, run_state(evolution, scene_));
    if (comm_.is_root() && !result.empty()) files_->log->info("{}", result);
}

std::string Recorder::after_failure(Evolution& evolution) {
    const std::filesystem::path folder = folder_ / "failed";
    std::string message = fmt::format("last checkpoint: {}", last_checkpoint_.string());
    try {
        agree_on_root(comm_, [&] { std::filesystem::create_directories(folder); });
        evolution.save(
            [&](const auto& sets) { write_checkpoint(comm_, folder, run_state(evolution, scene_), sets); });
        message += fmt::format("\nstate that failed: {}", find_checkpoint(comm_, folder, folder_).string());
    } catch (const AgreedError& error) {
        message += fmt::format("\nthe state that failed could not be kept: {}", error.what());
    }
    return message;
}

void Recorder::write_checkpoint_now(Evolution& evolution) {
    const auto began = std::chrono::steady_clock::now();
    const RunState state = run_state(evolution, scene_);
    evolution.save([&](const auto& sets) { write_checkpoint(comm_, folder_, state, sets); });
    last_checkpoint_ = find_checkpoint(comm_, "latest", folder_);
    last_checkpoint_time_ = std::chrono::steady_clock::now();
    checkpoint_seconds_ = std::chrono::duration<double>(last_checkpoint_time_ - began).count();
}

void Recorder::write_snapshot_now(Evolution& evolution, std::uint64_t index) {
    last_snapshot_step_ = evolution.step_count();
    evolution.save([&](const auto&) {
        write_snapshot(comm_, folder_, index, run_state(evolution, scene_), evolution.particles(),
                       evolution.snapshot_fields());
        for (const SnapshotSet& more : evolution.more_snapshots())
            write_snapshot(comm_, folder_, index, run_state(evolution, scene_), more.set, more.fields);
    });
}

void Recorder::write_analysis(const Evolution& evolution) {
    const std::string found = evolution.analyse(folder_, run_state(evolution, scene_));
    if (comm_.is_root() && !found.empty()) files_->log->info("{}", found);
}

void Recorder::write_diagnostics(Evolution& evolution) {
    const Diagnostics found = evolution.diagnostics();
    if (evolution.step_count() == 0) first_energy_ = found.total_energy;
    files_->diagnostics->write(evolution.step_count(), found.row);
}

void Recorder::write_performance(const Evolution& evolution, const PhaseTimer& timer, double seconds,
                                 std::uint64_t pairs) {
    const std::vector<PhaseTimer::Row> rows = timer.rows(comm_);
    const std::uint64_t memory = comm_.all_sum(peak_memory());
    const std::uint64_t messages = comm_.all_max(evolution.decomposition().halo().messages_sent());
    const std::uint64_t bytes = comm_.all_max(evolution.decomposition().halo().bytes_sent());
    const std::string more = evolution.performance();
    const std::uint64_t copies = comm_.all_max(static_cast<std::uint64_t>(evolution.particles().halo_size()));
    agree_on_root(comm_, [&] {
        std::string phases;
        for (const auto& row : rows)
            phases += fmt::format("{}\"{}\": {:.6g}", phases.empty() ? "" : ", ", row.phase, row.average);
        std::ofstream file(folder_ / "performance.json");
        file << fmt::format(
            "{{\"ranks\": {}, \"particles\": {}, \"steps\": {}, \"seconds\": {:.6g}, \"pairs\": {}, "
            "\"field_bytes_per_particle\": {}, \"peak_memory_bytes\": {}, \"messages_of_a_rank\": {}, "
            "\"message_bytes_of_a_rank\": {}, \"copies_of_a_rank\": {}, {}\"imbalance\": {:.4g}, "
            "\"phase_seconds\": {{{}}}}}\n",
            comm_.size(), evolution.total_particles(), evolution.step_count() - first_step_, seconds, pairs,
            evolution.particles().bytes_per_particle(), memory, messages, bytes, copies, more,
            evolution.decomposition().measured_imbalance(), phases);
        file.close();
        if (!file)
            throw std::runtime_error((folder_ / "performance.json").string() + " could not be written");
    });
}

void Recorder::print_summary(Evolution& evolution, const std::string& more) {
    files_->performance->write(evolution);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
    PhaseTimer timer;
    for (std::size_t p = 0; p < phase_names.size(); ++p)
        timer.add(phase_names[p], evolution.phases().seconds()[p], evolution.phases().entries()[p]);
    const std::string table = timer.report(comm_, seconds);
    const std::uint64_t pairs = comm_.all_sum(evolution.pairs());
    const double energy = evolution.diagnostics().total_energy;
    write_performance(evolution, timer, seconds, pairs);
    if (!comm_.is_root()) return;
    const auto steps = static_cast<double>(evolution.step_count() - first_step_);
    const double updates = steps * static_cast<double>(evolution.total_particles());
    files_->log->info(
        "step {}, time {:.6g} s after {:.1f} s: {:.4g} particle-steps/s, {:.1f} pairs per particle and step",
        evolution.step_count(), evolution.time(), seconds, updates / seconds,
        updates > 0 ? static_cast<double>(pairs) / updates : 0.0);
    if (first_energy_ != 0) {
        files_->log->info("total energy {:.9g} J, changed by {:.1e} of its first value", energy,
                          energy / first_energy_ - 1);
    }
    if (!more.empty()) files_->log->info("{}", more);
    files_->log->info("decomposition cut {} times, imbalance of work {:.3f}\n{}",
                      evolution.decomposition().rebalance_count(),
                      evolution.decomposition().measured_imbalance(), table);
}

}  // namespace talus
