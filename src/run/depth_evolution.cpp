#include "src/run/depth_evolution.hpp"

#include <fmt/format.h>

#include <chrono>

#include "domain/depth_fields.hpp"
#include "domain/pore_pressure_field.hpp"
#include "domain/two_phase_fields.hpp"
#include "io/checkpoint.hpp"
#include "src/run/scene_checks.hpp"

namespace talus {

DepthEvolution::DepthEvolution(const Communicator& comm, const Scene& scene, std::optional<double> until)
    : comm_(comm),
      scene_(scene),
      setup_(read_depth_scene(comm, scene)),
      end_time_(until.value_or(setup_.output.end_time)) {
    check_snapshots(scene, setup_.output, end_time_);
    if (setup_.results.frame.rows > 0) record_.emplace(setup_.results.frame, setup_.results.threshold);
}

std::vector<std::string> DepthEvolution::warnings() const {
    constexpr double gentle = 0.1;  // beyond it the vertical form is wrong by a percent
    const Terrain& terrain = *setup_.simulation.terrain;
    std::vector<std::string> found = setup_.notes;
    if (setup_.simulation.settings.form == depth::Form::bed_fitted || !terrain.is_plane()) return found;
    const auto slope = terrain.slope(0, 0);
    const double steepness = std::hypot(slope[0], slope[1]);
    if (steepness > gentle)
        found.push_back(
            fmt::format("the bed has a slope of {:.3g}, for which depth.form = \"cartesian\" is not meant; "
                        "\"bed_fitted\" is",
                        steepness));
    return found;
}

void DepthEvolution::create(const std::function<void()>&) {
    simulation_.emplace(comm_, setup_.simulation, make_columns(comm_, setup_));
    check_box();
}

void DepthEvolution::check_box() const {
    refuse_short_box(scene_, setup_.simulation.box, simulation_->interaction_radius());
}

ReadCheckpoint DepthEvolution::read(const std::filesystem::path& what,
                                    const std::filesystem::path& output_folder) {
    const auto began = std::chrono::steady_clock::now();
    ReadCheckpoint found{find_checkpoint(comm_, what, output_folder), {}, 0};
    ParticleSet particles = empty_columns(setup_.simulation);
    ParticleSet cells = FlowRecord::empty_set();
    std::vector<ParticleSet*> sets{&particles};
    if (record_) sets.push_back(&cells);
    found.state = read_checkpoint(comm_, found.file, sets);
    if (record_) {
        record_->restore(comm_, cells);
        record_->share(comm_);
    }
    simulation_.emplace(comm_, setup_.simulation, std::move(particles));
    check_box();
    found.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    return found;
}

void DepthEvolution::start() {
    simulation_->start();
    if (record_) add_columns(*record_, *simulation_);
}

void DepthEvolution::step() {
    simulation_->step();
    if (record_) add_columns(*record_, *simulation_);
}

void DepthEvolution::save(const WriteSets& write) {
    if (!record_) return write({&simulation_->particles()});
    const ParticleSet cells = record_->save(comm_);
    write({&simulation_->particles(), &cells});
}

std::string DepthEvolution::analyse(const std::filesystem::path& folder, const RunState&) const {
    return record_ ? write_results(*simulation_, *record_, setup_.results, folder) : "";
}

std::vector<std::string> DepthEvolution::news() {
    std::string note = simulation_->outflow().take_note();
    if (note.empty()) return {};
    return {std::move(note)};
}

std::vector<SnapshotField> DepthEvolution::snapshot_fields() const {
    std::vector<SnapshotField> fields;
    for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
             &field::velocity, &field::depth, &field::volume, &field::smoothing_length,
             &field::excess_pore_pressure, &field::is_water, &field::other_height})
        if (simulation_->particles().has(*info)) fields.push_back({.field = info});
    return fields;
}

std::vector<CsvColumn> DepthEvolution::diagnostics_columns() const {
    std::vector<CsvColumn> columns{{"time", "s"},
                                   {"time_step", "s"},
                                   {"volume", "m3"},
                                   {"kinetic_energy", "J"},
                                   {"potential_energy", "J"},
                                   {"momentum_x", "kg m s-1"},
                                   {"momentum_y", "kg m s-1"},
                                   {"centre_x", "m"},
                                   {"centre_y", "m"},
                                   {"least_x", "m"},
                                   {"greatest_x", "m"},
                                   {"least_y", "m"},
                                   {"greatest_y", "m"},
                                   {"greatest_speed", "m s-1"},
                                   {"greatest_depth", "m"},
                                   {"stopped", "1"},
                                   {"outflow_particles", "1"},
                                   {"outflow_volume", "m3"}};
    if (setup_.simulation.settings.two_phase)
        columns.insert(columns.end(),
                       {{"water_volume", "m3"}, {"water_centre_x", "m"}, {"water_centre_y", "m"}});
    if (setup_.simulation.settings.merging_distance > 0) columns.push_back({"columns", "1"});
    for (const Gauge& gauge : setup_.gauges) {
        columns.push_back({"depth_" + gauge.name, "m"});
        columns.push_back({"level_" + gauge.name, "m"});
    }
    return columns;
}

Diagnostics DepthEvolution::diagnostics() {
    const DepthTotals t = simulation_->totals();
    Diagnostics found{
        {simulation_->time(), simulation_->time_step(), t.volume, t.kinetic_energy, t.potential_energy,
         t.momentum[0], t.momentum[1], t.centre[0], t.centre[1], t.least_place[0], t.greatest_place[0],
         t.least_place[1], t.greatest_place[1], t.greatest_speed, t.greatest_depth, t.stopped,
         static_cast<double>(simulation_->outflow().count()), simulation_->outflow().volume()},
        0};
    if (setup_.simulation.settings.two_phase)
        found.row.insert(found.row.end(), {t.water_volume, t.water_centre[0], t.water_centre[1]});
    if (setup_.simulation.settings.merging_distance > 0)
        found.row.push_back(static_cast<double>(simulation_->total_particles()));
    if (setup_.gauges.empty()) return found;
    for (const GaugeReading& reading : read_gauges(*simulation_, setup_.gauges)) {
        found.row.push_back(reading.depth);
        found.row.push_back(reading.level);
    }
    return found;
}

std::string DepthEvolution::summary() const {
    const DepthTotals t = simulation_->totals();
    return fmt::format("flow: {:.6g} m3, {:.4g} of it at rest; from ({:.6g}, {:.6g}) to ({:.6g}, {:.6g}) m{}",
                       t.volume, t.stopped, t.least_place[0], t.least_place[1], t.greatest_place[0],
                       t.greatest_place[1],
                       simulation_->outflow().count() > 0
                           ? fmt::format("; {:.6g} m3 have left the terrain", simulation_->outflow().volume())
                           : "");
}

}  // namespace talus
