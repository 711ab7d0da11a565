#include "src/run/coupled_evolution.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <utility>

#include "domain/coupling_fields.hpp"
#include "domain/grain_fields.hpp"
#include "io/checkpoint.hpp"
#include "src/flow/contact_set.hpp"
#include "src/run/options.hpp"
#include "src/run/scene_checks.hpp"
#include "src/setup/wall_reader.hpp"

namespace talus {

CoupledEvolution::CoupledEvolution(const Communicator& comm, const Scene& scene, std::optional<double> until)
    : comm_(comm),
      scene_(scene),
      setup_(read_coupled_scene(comm, scene)),
      end_time_(until.value_or(setup_.water.output.end_time)),
      record_(setup_.water.simulation, setup_.water.body_names(), setup_.water.gauges),
      speed_(most_speed_of_water * setup_.water.simulation.settings.state.sound_speed) {
    check_snapshots(scene, output(), end_time_);
    refuse_short_box(scene, setup_.water.simulation.box, setup_.kernel_radius);
}

std::vector<std::string> CoupledEvolution::warnings() const {
    std::vector<std::string> found = setup_.warnings;
    for (const std::vector<std::string>& more :
         {water_warnings(setup_.water, simulation_->water().time_step()), core_warnings_,
          setup_.grains.warnings})
        found.insert(found.end(), more.begin(), more.end());
    return found;
}

std::vector<std::string> CoupledEvolution::news() {
    std::vector<std::string> found = simulation_->grains().take_notes();
    if (overlap_.is_due()) found.push_back(overlap_note(time(), overlap_.greatest()));
    if (speed_.is_due())
        found.push_back(
            speed_note(time(), speed_.greatest(), setup_.water.simulation.settings.state.sound_speed));
    return found;
}

void CoupledEvolution::create(const std::function<void()>& check_stop) {
    CoupledSetup setup = setup_.simulation();
    const bool settles = check_stop && setup_.grains.simulation.settling;
    if (settles) setup.grains.settling = setup_.grains.simulation.settling;
    simulation_.emplace(comm_, std::move(setup), make_water(comm_, setup_.water),
                        make_grains(comm_, setup_.grains));
    if (settles) simulation_->settle(check_stop);
}

void CoupledEvolution::start() {
    simulation_->start();
    core_warnings_ = core_warnings(simulation_->water());
    const double least = setup_.coupling.laws.least_fluid_fraction;
    if (const CouplingTotals t = simulation_->totals(); t.least_fluid_fraction < least)
        scene_.root().error(
            "grains", fmt::format("they leave {:.3g} of the volume to the water somewhere at the start, "
                                  "denser than grains pack; allowed: at least "
                                  "coupling.least_fluid_fraction = {:.3g}",
                                  t.least_fluid_fraction, least));
    refuse_first_overlap(scene_, simulation_->grains().totals().greatest_overlap);
    scene_.finish();
}

std::vector<std::string> CoupledEvolution::bodies() const {
    std::vector<std::string> names;
    const auto& walls = setup_.water.simulation.walls;
    for (std::size_t b = 0; b < setup_.water.bodies.size(); ++b)
        names.push_back(fmt::format("{} ({})", setup_.water.bodies[b].name,
                                    !walls.empty() && walls[b] ? "wall" : "water"));
    for (const GrainBody& body : setup_.grains.bodies) names.push_back(fmt::format("{} (grains)", body.name));
    return names;
}

ReadCheckpoint CoupledEvolution::read(const std::filesystem::path& what,
                                      const std::filesystem::path& output_folder) {
    const auto began = std::chrono::steady_clock::now();
    ReadCheckpoint found{find_checkpoint(comm_, what, output_folder), {}, 0};
    found.state = read_checkpoint_state(comm_, found.file);
    if (const std::vector<std::string> wanted = bodies(); found.state.materials != wanted)
        throw AgreedError(exit_input_output,
                          fmt::format("{}: is of the bodies {}; this scene has {}", found.file.string(),
                                      fmt::join(found.state.materials, ", "), fmt::join(wanted, ", ")));
    if (const std::vector<std::string> wanted = names_of_walls(setup_.grains.simulation.walls);
        found.state.walls != wanted)
        throw AgreedError(
            exit_input_output,
            fmt::format("{}: is of a scene with other walls of grains: {}; this one has {}",
                        found.file.string(), fmt::join(found.state.walls, ", "), fmt::join(wanted, ", ")));
    constexpr double rounding = 1e-9;
    if (const double step = setup_.grains.simulation.time_step; step > found.state.time_step * (1 + rounding))
        scene_.root().section("dem").error(
            "time_step", fmt::format("{} s is above the next step of the water in the checkpoint; allowed: "
                                     "at most {} s",
                                     step, found.state.time_step));
    take_history_kernel(scene_, found.state.numbers, setup_);
    if (const auto& kernel = setup_.coupling.laws.basset;
        kernel && kernel->longest() < end_time_ && !scene_.root().section("coupling").has("basset_memory"))
        setup_.warnings.push_back(
            fmt::format("Basset's force goes on with the memories of the checkpoint, which last for {} s "
                        "(coupling.basset_memory), and the run for {} s",
                        kernel->longest(), end_time_));
    ParticleSet water = empty_water(setup_.water.simulation), grains = empty_grains(setup_.grains.simulation),
                contacts = dem::empty_contacts(3, GrainSimulation::history_fields(setup_.grains.simulation));
    read_checkpoint(comm_, found.file, {&water, &grains, &contacts});
    simulation_.emplace(comm_, setup_.simulation(), std::move(water), std::move(grains));
    read_contacts_ = std::move(contacts);
    found.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    return found;
}

void CoupledEvolution::resume(const RunState& state) {
    simulation_->resume(state.time, state.time_step, state.step, state.numbers, *read_contacts_);
    read_contacts_.reset();
}

void CoupledEvolution::describe(RunState& state) const {
    state.materials = bodies();
    state.walls = names_of_walls(setup_.grains.simulation.walls);
    simulation_->save_numbers(state.numbers);
}

void CoupledEvolution::save(const WriteSets& write) {
    const ParticleSet contacts = simulation_->grains().save();
    write({&simulation_->water().particles(), &std::as_const(*simulation_).grains().grains(), &contacts});
}

std::vector<SnapshotField> CoupledEvolution::snapshot_fields() const {
    std::vector<SnapshotField> fields;
    for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
             &field::velocity, &field::mass, &field::density, &field::pressure, &field::body,
             &coupling_field::solid_fraction})
        fields.push_back({.field = info});
    return fields;
}

std::vector<SnapshotSet> CoupledEvolution::more_snapshots() {
    std::vector<SnapshotField> fields;
    for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
             &field::velocity, &field::angular_velocity, &field::radius, &field::mass, &field::body,
             &coupling_field::fluid_acceleration})
        fields.push_back({.field = info});
    std::vector<SnapshotSet> sets;
    sets.push_back({std::as_const(*simulation_).grains().grains(), fields});
    return sets;
}

std::vector<CsvColumn> CoupledEvolution::diagnostics_columns() const {
    std::vector<CsvColumn> columns{{"time", "s"},
                                   {"time_step", "s"},
                                   {"water_mass", "kg"},
                                   {"water_kinetic_energy", "J"},
                                   {"grain_mass", "kg"},
                                   {"grain_kinetic_energy", "J"},
                                   {"greatest_water_speed", "m s-1"},
                                   {"greatest_grain_speed", "m s-1"},
                                   {"least_pressure", "Pa"},
                                   {"greatest_pressure", "Pa"}};
    for (const char* of : {"water", "grain"})
        for (const char axis : {'x', 'y', 'z'})
            columns.push_back({fmt::format("{}_momentum_{}", of, axis), "kg m s-1"});
    for (const char axis : {'x', 'y', 'z'}) columns.push_back({fmt::format("force_on_grains_{}", axis), "N"});
    for (const char axis : {'x', 'y', 'z'}) columns.push_back({fmt::format("least_water_{}", axis), "m"});
    for (const char axis : {'x', 'y', 'z'}) columns.push_back({fmt::format("greatest_water_{}", axis), "m"});
    for (const char axis : {'x', 'y', 'z'}) columns.push_back({fmt::format("mean_grain_{}", axis), "m"});
    columns.insert(columns.end(), {{"exchange_imbalance", "1"},
                                   {"least_fluid_fraction", "1"},
                                   {"clipped", "1"},
                                   {"grain_volume", "m3"},
                                   {"spread_volume", "m3"},
                                   {"substeps", "1"},
                                   {"contacts", "1"}});
    for (CsvColumn& column : record_.columns()) columns.push_back(std::move(column));
    if (simulation_->holds_some_grains())
        for (const char axis : {'x', 'y', 'z'})
            columns.push_back({fmt::format("force_on_held_grains_{}", axis), "N"});
    return columns;
}

Diagnostics CoupledEvolution::diagnostics() {
    const WaterTotals w = simulation_->water().totals();
    const GrainTotals g = simulation_->grains().totals();
    const CouplingTotals c = simulation_->totals();
    speed_.see(w.greatest_speed);
    overlap_.see(g.greatest_overlap);
    Diagnostics found{{time(), time_step(), w.mass, w.kinetic_energy, g.mass, g.kinetic_energy,
                       w.greatest_speed, g.greatest_speed, w.least_pressure, w.greatest_pressure},
                      0};
    for (const auto& values :
         {w.momentum, g.momentum, c.force, w.least_place, w.greatest_place, c.mean_place})
        found.row.insert(found.row.end(), values.begin(), values.end());
    found.row.insert(
        found.row.end(),
        {c.imbalance, c.least_fluid_fraction, static_cast<double>(c.clipped), c.grain_volume, c.spread_volume,
         static_cast<double>(simulation_->substeps()), static_cast<double>(g.contacts)});
    record_.measure(simulation_->water(), found.row);
    if (simulation_->holds_some_grains())
        found.row.insert(found.row.end(), c.held_force.begin(), c.held_force.end());
    return found;
}

std::string CoupledEvolution::summary() const {
    const CouplingTotals c = simulation_->totals();
    return fmt::format(
        "water and {} grains: forces balance to {:.1e}, least share of water {:.3g}, {} of its particles "
        "below the least that counts, {:.6g} of the grains' volume seen by the water; {} steps of grains "
        "in the next of the water",
        simulation_->grains().total_grains(), c.imbalance, c.least_fluid_fraction, c.clipped,
        c.grain_volume > 0 ? c.spread_volume / c.grain_volume : 0.0, simulation_->substeps());
}

std::string CoupledEvolution::performance() const {
    return fmt::format("\"grains\": {}, \"exchange_pairs\": {}, ", simulation_->grains().total_grains(),
                       comm_.all_sum(simulation_->pairs()));
}

}  // namespace talus
