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
#include "src/run/warnings.hpp"

namespace talus {

namespace {

std::vector<CsvColumn> diagnostics_columns(const Setup& setup) {
    std::vector<CsvColumn> columns = {
        {"time", "s"},
        {"time_step", "s"},
        {"mass", "kg"},
        {"kinetic_energy", "J"},
        {"internal_energy", "J"},
        {"total_energy", "J"},
        {"momentum_x", "kg m s-1"},
        {"momentum_y", "kg m s-1"},
        {"momentum_z", "kg m s-1"},
        {"angular_momentum_x", "kg m2 s-1"},
        {"angular_momentum_y", "kg m2 s-1"},
        {"angular_momentum_z", "kg m2 s-1"},
        {"greatest_speed", "m s-1"},
        {"least_density", "kg m-3"},
        {"greatest_density", "kg m-3"},
        {"least_pressure", "Pa"},
        {"greatest_pressure", "Pa"},
        {"mean_damage", "1"},
    };
    if (setup.gravity) {
        columns.push_back({"potential_energy", "J"});
        columns.push_back({"gravity_drift", "1"});
    }
    return columns;
}

/// Whether an output that is due every `interval` fell due between two times; every call if it is 0.
bool fell_due(double before, double now, double interval) {
    return interval <= 0 || std::floor(now / interval) > std::floor(before / interval);
}

RunState run_state(const Simulation& simulation, const Scene& scene) {
    RunState state;
    state.time = simulation.time();
    state.time_step = simulation.time_step();
    state.step = simulation.step_count();
    state.scene_text = scene.text();
    state.resolved_scene = scene.resolved();
    state.version = TALUS_VERSION;
    if (simulation.in_late_phase()) state.numbers["late_phase"] = simulation.setup().late_phase->stiffness;
    for (const Material& material : simulation.setup().materials) state.materials.push_back(material.name);
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
                   const SceneSetup& setup, bool is_new)
    : comm_(comm),
      folder_(std::move(folder)),
      scene_(scene),
      setup_(setup),
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

void Recorder::go_on_from(const Restart& restart) {
    last_checkpoint_ = restart.file;
    checkpoint_seconds_ = restart.seconds;
    if (!comm_.is_root()) return;
    files_->log->info("going on from {} (step {}, time {} s)", restart.file.string(), restart.state.step,
                      restart.state.time);
    if (restart.state.resolved_scene != scene_.resolved())
        files_->log->warn("the scene differs from the one that wrote this checkpoint");
}

void Recorder::note(const std::vector<Settling>& settlings) {
    if (!comm_.is_root()) return;
    for (const Settling& settling : settlings) files_->log->info("{}", describe(settling));
}

void Recorder::begin(Simulation& simulation, double end_time) {
    first_step_ = simulation.step_count();
    time_before_ = simulation.time();
    if (comm_.is_root()) {
        files_->log->info("{}", setup_.title);
        files_->log->info(
            "{} particles on {} ranks, {} bytes per particle in fields, first step {:.4g} s, results in {}",
            simulation.total_particles(), comm_.size(), simulation.particles().bytes_per_particle(),
            simulation.time_step(), folder_.string());
    }
    if (comm_.is_root())
        for (const std::string& warning : warnings(setup_)) files_->log->warn("note: {}", warning);
    const std::optional<std::uint64_t> restart_step =
        is_new_ ? std::nullopt : std::optional<std::uint64_t>(simulation.step_count());
    files_->diagnostics = std::make_unique<CsvWriter>(comm_, folder_ / "diagnostics.csv",
                                                      diagnostics_columns(setup_.simulation), restart_step);
    files_->performance = std::make_unique<PerformanceLog>(comm_, folder_, restart_step);
    if (is_new_) {
        write_diagnostics(simulation);
        write_snapshot_now(simulation, 0);
        write_checkpoint_now(simulation);
    }
    files_->progress = std::make_unique<Progress>(comm_.is_root(), Progress::Goal{end_time, {}});
    simulation.reset_counters();
    files_->performance->begin(simulation);
    began_ = step_began_ = last_checkpoint_time_ = std::chrono::steady_clock::now();
}

void Recorder::after_step(Simulation& simulation) {
    const double time = simulation.time();
    simulation.phases().enter(Phase::output);
    if (fell_due(time_before_, time, setup_.output.diagnostics_interval)) {
        write_diagnostics(simulation);
        files_->performance->write(simulation);
    }
    if (const double interval = setup_.output.snapshot_interval;
        interval > 0 && fell_due(time_before_, time, interval))
        write_snapshot_now(simulation, static_cast<std::uint64_t>(time / interval));
    const auto now = std::chrono::steady_clock::now();
    if (setup_.output.checkpoint_interval > 0) {
        const std::chrono::duration<double> since = now - last_checkpoint_time_;
        if (comm_.all_max(static_cast<int>(since.count() > setup_.output.checkpoint_interval)))
            write_checkpoint_now(simulation);
    }
    files_->progress->update(simulation.step_count(), time, simulation.time_step(),
                             simulation.total_particles());
    simulation.phases().stop();
    time_before_ = time;
    longest_step_ = std::max(longest_step_, std::chrono::duration<double>(now - step_began_).count());
    step_began_ = std::chrono::steady_clock::now();
}

void Recorder::stop_early(Simulation& simulation, const std::string& why) {
    files_->progress->finish();
    write_checkpoint_now(simulation);
    if (comm_.is_root())
        files_->log->info("stopped early: {}; go on with --restart latest (step {}, time {} s)", why,
                          simulation.step_count(), simulation.time());
    print_summary(simulation);
}

void Recorder::finish(Simulation& simulation) {
    files_->progress->finish();
    if (!is_new_ && simulation.step_count() == first_step_) {
        // What is there is complete; work fields, which snapshots hold, have no values before a step.
        if (comm_.is_root())
            files_->log->info("nothing left to do at step {}, time {} s", first_step_, simulation.time());
        write_analysis(simulation);
        return;
    }
    write_checkpoint_now(simulation);
    if (last_snapshot_step_ != simulation.step_count()) {  // the last state, due or not
        const double interval = setup_.output.snapshot_interval;
        write_snapshot_now(simulation,
                           1 + (interval > 0 ? static_cast<std::uint64_t>(simulation.time() / interval) : 0));
    }
    write_analysis(simulation);
    print_summary(simulation);
}

void Recorder::hand_over(const Simulation& simulation, const HandOff& result) {
    const std::filesystem::path file = folder_ / "grains.h5";
    write_particle_sets(comm_, file, run_state(simulation, scene_), {&result.grains});
    if (comm_.is_root()) files_->log->info("{}; {}", describe(result), file.string());
}

std::string Recorder::after_failure(const Simulation& simulation) {
    const std::filesystem::path folder = folder_ / "failed";
    std::string message = fmt::format("last checkpoint: {}", last_checkpoint_.string());
    try {
        agree_on_root(comm_, [&] { std::filesystem::create_directories(folder); });
        write_checkpoint(comm_, folder, run_state(simulation, scene_), {&simulation.particles()});
        message += fmt::format("\nstate that failed: {}", find_checkpoint(comm_, folder, folder_).string());
    } catch (const AgreedError& error) {
        message += fmt::format("\nthe state that failed could not be kept: {}", error.what());
    }
    return message;
}

void Recorder::write_checkpoint_now(Simulation& simulation) {
    const auto began = std::chrono::steady_clock::now();
    const RunState state = run_state(simulation, scene_);
    write_checkpoint(comm_, folder_, state, {&simulation.particles()});
    last_checkpoint_ = find_checkpoint(comm_, "latest", folder_);
    last_checkpoint_time_ = std::chrono::steady_clock::now();
    checkpoint_seconds_ = std::chrono::duration<double>(last_checkpoint_time_ - began).count();
}

void Recorder::write_snapshot_now(Simulation& simulation, std::uint64_t index) {
    last_snapshot_step_ = simulation.step_count();
    const ParticleSet& particles = simulation.particles();
    std::vector<SnapshotField> fields;
    for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
             &field::velocity, &field::mass, &field::internal_energy, &field::smoothing_length, &field::body,
             &field::pressure, &field::sound_speed, &field::deviatoric_stress, &field::damage})
        if (particles.has(*info)) fields.push_back({.field = info});
    fields.push_back({.field = particles.has(field::density) ? &field::density : &field::predicted_density,
                      .name = snapshot_name(field::density)});
    write_snapshot(comm_, folder_, index, run_state(simulation, scene_), particles, fields);
}

void Recorder::write_analysis(const Simulation& simulation) {
    const AnalysisPlan& plan = setup_.analysis;
    if (!plan.asks_for_anything()) return;
    const Breakup breakup = analyse(comm_, plan, setup_.simulation.box, simulation.particles());
    write_breakup(comm_, folder_, run_state(simulation, scene_), plan, breakup);
    if (comm_.is_root()) files_->log->info("{}", describe(plan, breakup));
}

void Recorder::write_diagnostics(Simulation& simulation) {
    const Totals t = simulation.totals();
    std::vector<double> row = {simulation.time(),     simulation.time_step(), t.mass,
                               t.kinetic_energy,      t.internal_energy,      t.total_energy(),
                               t.momentum[0],         t.momentum[1],          t.momentum[2],
                               t.angular_momentum[0], t.angular_momentum[1],  t.angular_momentum[2],
                               t.greatest_speed,      t.least_density,        t.greatest_density,
                               t.least_pressure,      t.greatest_pressure,    t.mean_damage};
    if (simulation.gravity_counts()) row.insert(row.end(), {t.potential_energy, t.gravity_drift});
    if (simulation.step_count() == 0) first_energy_ = row[5];
    files_->diagnostics->write(simulation.step_count(), row);
}

void Recorder::write_performance(const Simulation& simulation, const PhaseTimer& timer, double seconds,
                                 std::uint64_t pairs) {
    const std::vector<PhaseTimer::Row> rows = timer.rows(comm_);
    const std::uint64_t memory = comm_.all_sum(peak_memory());
    const std::uint64_t messages = comm_.all_max(simulation.decomposition().halo().messages_sent());
    const std::uint64_t bytes = comm_.all_max(simulation.decomposition().halo().bytes_sent());
    std::string gravity;
    if (const gravity::Counts* counts = simulation.gravity_counts())
        gravity = fmt::format("\"gravity_interactions\": {}, \"gravity_bytes_of_a_rank\": {}, ",
                              comm_.all_sum(counts->interactions()), comm_.all_max(counts->bytes_sent));
    const std::uint64_t copies =
        comm_.all_max(static_cast<std::uint64_t>(simulation.particles().halo_size()));
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
            comm_.size(), simulation.total_particles(), simulation.step_count() - first_step_, seconds, pairs,
            simulation.particles().bytes_per_particle(), memory, messages, bytes, copies, gravity,
            simulation.decomposition().measured_imbalance(), phases);
        file.close();
        if (!file)
            throw std::runtime_error((folder_ / "performance.json").string() + " could not be written");
    });
}

void Recorder::print_summary(Simulation& simulation) {
    files_->performance->write(simulation);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
    PhaseTimer timer;
    for (std::size_t p = 0; p < phase_names.size(); ++p)
        timer.add(phase_names[p], simulation.phases().seconds()[p], simulation.phases().entries()[p]);
    const std::string table = timer.report(comm_, seconds);
    const std::uint64_t pairs = comm_.all_sum(simulation.pairs());
    const Totals totals = simulation.totals();
    const gravity::Counts* gravity = simulation.gravity_counts();
    const std::uint64_t interactions = gravity ? comm_.all_sum(gravity->interactions()) : 0;
    write_performance(simulation, timer, seconds, pairs);
    if (!comm_.is_root()) return;
    const auto steps = static_cast<double>(simulation.step_count() - first_step_);
    const double updates = steps * static_cast<double>(simulation.total_particles());
    files_->log->info(
        "step {}, time {:.6g} s after {:.1f} s: {:.4g} particle-steps/s, {:.1f} pairs per particle and step",
        simulation.step_count(), simulation.time(), seconds, updates / seconds,
        updates > 0 ? static_cast<double>(pairs) / updates : 0.0);
    if (first_energy_ != 0) {
        const double energy = totals.total_energy();
        files_->log->info("total energy {:.9g} J, changed by {:.1e} of its first value", energy,
                          energy / first_energy_ - 1);
    }
    if (gravity)
        files_->log->info(
            "gravity: {:.1f} interactions per particle and step; its forces add up to {:.1e} of their sizes",
            updates > 0 ? static_cast<double>(interactions) / updates : 0.0, totals.gravity_drift);
    files_->log->info("decomposition cut {} times, imbalance of work {:.3f}\n{}",
                      simulation.decomposition().rebalance_count(),
                      simulation.decomposition().measured_imbalance(), table);
}

}  // namespace talus
