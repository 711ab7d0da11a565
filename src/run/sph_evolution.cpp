#include "src/run/sph_evolution.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/checkpoint.hpp"
#include "physics/solid/late_phase.hpp"
#include "src/run/restart.hpp"
#include "src/run/scene_checks.hpp"
#include "src/run/warnings.hpp"

namespace talus {

SphEvolution::SphEvolution(const Communicator& comm, const Scene& scene, std::optional<double> until)
    : comm_(comm),
      scene_(scene),
      setup_(read_scene(comm, scene)),
      end_time_(until.value_or(setup_.output.end_time)) {
    if (setup_.hand_off && setup_.hand_off->at < end_time_) {
        if (until) unused_until_ = *until;
        end_time_ = setup_.hand_off->at;
    }
    check_plan(scene, setup_, end_time_);
}

std::vector<std::string> SphEvolution::warnings() const {
    std::vector<std::string> found = talus::warnings(setup_);
    if (unused_until_)
        found.push_back(fmt::format("the run ends at hand_off.at = {} s, before --until {} s", end_time_,
                                    *unused_until_));
    return found;
}

std::vector<std::string> SphEvolution::news() {
    const Clipped& clipped = simulation_->clipped_at_late_phase();
    if (clipped.particles == 0 || told_of_clipped_) return {};
    told_of_clipped_ = true;
    return {fmt::format(
        "late phase: {} particles lose pressure at the change, for they would have to be denser than {} "
        "times "
        "their density at rest, the first of them {}; a larger late_phase.stiffness or a later "
        "late_phase.from?",
        clipped.particles, most_compressed, clipped.first_id)};
}

void SphEvolution::create(const std::function<void()>& check_stop) {
    ParticleSet particles = make_particles(comm_, setup_);
    settlings_ = settle(comm_, setup_, particles, check_stop);
    simulation_.emplace(comm_, setup_.simulation, std::move(particles));
    check_box(scene_, *simulation_);
}

std::vector<std::string> SphEvolution::preparations() const {
    std::vector<std::string> lines;
    for (const Settling& settling : settlings_) lines.push_back(talus::describe(settling));
    return lines;
}

ReadCheckpoint SphEvolution::read(const std::filesystem::path& what,
                                  const std::filesystem::path& output_folder) {
    Restart restart = read_restart(comm_, what, output_folder, setup_);
    simulation_.emplace(comm_, setup_.simulation, std::move(restart.particles));
    check_box(scene_, *simulation_);
    return {restart.file, restart.state, restart.seconds};
}

void SphEvolution::describe(RunState& state) const {
    if (simulation_->in_late_phase()) state.numbers["late_phase"] = setup_.simulation.late_phase->stiffness;
    for (const Material& material : setup_.simulation.materials) state.materials.push_back(material.name);
}

std::vector<SnapshotField> SphEvolution::snapshot_fields() const {
    const ParticleSet& particles = simulation_->particles();
    std::vector<SnapshotField> fields;
    for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
             &field::velocity, &field::mass, &field::internal_energy, &field::smoothing_length, &field::body,
             &field::pressure, &field::sound_speed, &field::deviatoric_stress, &field::damage,
             &field::plastic_volume_strain, &field::plastic_shear_strain})
        if (particles.has(*info)) fields.push_back({.field = info});
    fields.push_back({.field = particles.has(field::density) ? &field::density : &field::predicted_density,
                      .name = snapshot_name(field::density)});
    return fields;
}

std::vector<CsvColumn> SphEvolution::diagnostics_columns() const {
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
    const bool attracts = setup_.simulation.gravity.has_value();
    if (attracts || setup_.simulation.even_gravity) columns.push_back({"potential_energy", "J"});
    if (attracts) columns.push_back({"gravity_drift", "1"});
    return columns;
}

Diagnostics SphEvolution::diagnostics() {
    const Totals t = simulation_->totals();
    std::vector<double> row = {simulation_->time(),
                               simulation_->time_step(),
                               t.mass,
                               t.kinetic_energy,
                               t.internal_energy,
                               t.total_energy(),
                               t.momentum[0],
                               t.momentum[1],
                               t.momentum[2],
                               t.angular_momentum[0],
                               t.angular_momentum[1],
                               t.angular_momentum[2],
                               t.greatest_speed,
                               t.least_density,
                               t.greatest_density,
                               t.least_pressure,
                               t.greatest_pressure,
                               t.mean_damage};
    const bool attracts = setup_.simulation.gravity.has_value();
    if (attracts || setup_.simulation.even_gravity) row.push_back(t.potential_energy);
    if (attracts) row.push_back(t.gravity_drift);
    return {row, t.total_energy()};
}

std::string SphEvolution::summary() const {
    const gravity::Counts* gravity = simulation_->gravity_counts();
    if (!gravity) return {};
    const auto interactions = static_cast<double>(comm_.all_sum(gravity->interactions()));
    const double drift = simulation_->totals().gravity_drift;
    const double updates =
        static_cast<double>(step_count() - counted_from_) * static_cast<double>(total_particles());
    return fmt::format(
        "gravity: {:.1f} interactions per particle and step; its forces add up to {:.1e} of their sizes",
        updates > 0 ? interactions / updates : 0.0, drift);
}

std::string SphEvolution::performance() const {
    const gravity::Counts* counts = simulation_->gravity_counts();
    if (!counts) return {};
    return fmt::format("\"gravity_interactions\": {}, \"gravity_bytes_of_a_rank\": {}, ",
                       comm_.all_sum(counts->interactions()), comm_.all_max(counts->bytes_sent));
}

std::string SphEvolution::analyse(const std::filesystem::path& folder, const RunState& state) const {
    const AnalysisPlan& plan = setup_.analysis;
    if (!plan.asks_for_anything()) return {};
    const Breakup breakup = talus::analyse(comm_, plan, setup_.simulation.box, simulation_->particles());
    write_breakup(comm_, folder, state, plan, breakup);
    return talus::describe(plan, breakup);
}

std::string SphEvolution::hand_over(const std::filesystem::path& folder, const RunState& state) const {
    if (!setup_.hand_off || time() < setup_.hand_off->at) return {};
    const HandOff result = hand_off(comm_, *setup_.hand_off, setup_.simulation.box, simulation_->particles());
    const std::filesystem::path file = folder / "grains.h5";
    write_particle_sets(comm_, file, state, {&result.grains});
    return fmt::format("{}; {}", talus::describe(result), file.string());
}

}  // namespace talus
