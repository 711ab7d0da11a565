#include "src/run/grain_evolution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "domain/grain_fields.hpp"
#include "io/agree.hpp"
#include "io/checkpoint.hpp"
#include "src/flow/contact_set.hpp"
#include "src/run/flow_columns.hpp"
#include "src/run/scene_checks.hpp"
#include "src/setup/hard_impacts.hpp"
#include "src/setup/wall_reader.hpp"

namespace talus {

namespace {

/// Whether it is of interest: without self-gravity and grains of another run walls and boxes change it.
bool knows_angular_momentum(const GrainScene& scene) {
    const auto handed = [](const GrainBody& body) { return body.handed.has_value(); };
    return scene.simulation.self_gravity || std::any_of(scene.bodies.begin(), scene.bodies.end(), handed);
}

std::string listed(const std::vector<std::string>& walls) {
    return walls.empty() ? "no walls" : fmt::format("the walls {}", fmt::join(walls, ", "));
}

double sheared_in_a_step(const GrainSetup& setup) { return setup.box.shear_rate * setup.time_step; }

}  // namespace

GrainEvolution::GrainEvolution(const Communicator& comm, const Scene& scene, std::optional<double> until)
    : comm_(comm),
      scene_(scene),
      setup_(read_grain_scene(comm, scene)),
      end_time_(until.value_or(setup_.output.end_time)) {}

std::vector<std::string> GrainEvolution::warnings() const {
    constexpr double worth_noting = 0.001;
    std::vector<std::string> found = setup_.warnings;
    if (first_overlap_ > worth_noting)
        found.push_back(fmt::format(
            "grains overlap at the start, by up to {:.3g} of the smaller radius: they will push each other "
            "apart",
            first_overlap_));
    found.insert(found.end(), impact_warnings_.begin(), impact_warnings_.end());
    return found;
}

void GrainEvolution::create(const std::function<void()>&) {
    ParticleSet grains = make_grains(comm_, setup_);
    if (setup_.shrinks_overlapping) {
        shrunk_ = shrink_overlapping(comm_, setup_.simulation.box, grains);
        constexpr double least = 0.5;  // then no centre was within another grain, if both had one size
        if (shrunk_.least < least)
            scene_.root().section("dem").error(
                "overlaps",
                fmt::format("grain {} would shrink to {:.3g} of its radius; allowed: {}; join grains "
                            "that are so close, as hand_off.link does",
                            shrunk_.id, shrunk_.least, least));
        scene_.finish();
    }
    simulation_.emplace(comm_, setup_.simulation, std::move(grains));
    simulation_->start();
    first_overlap_ = simulation_->totals().greatest_overlap;
    refuse_first_overlap(scene_, first_overlap_);
    const ImpactFindings impacts = find_hard_impacts(comm_, setup_, simulation_->grains());
    impact_warnings_ = impacts.warnings;
    for (const std::string& fault : impacts.faults) scene_.root().section("dem").error("time_step", fault);
    const double stable = simulation_->stable_step_of_bonds();
    if (simulation_->time_step() > stable)
        scene_.root().section("dem").error(
            "time_step", fmt::format("is {} s, above the stable one of the bonds; allowed: at most {:.4g} s",
                                     simulation_->time_step(), stable));
    scene_.finish();
}

std::vector<std::string> GrainEvolution::preparations() const {
    if (shrunk_.grains == 0) return {};
    return {fmt::format("{} grains that overlapped were made smaller, grain {} most, to {:.3g} of its radius",
                        shrunk_.grains, shrunk_.id, shrunk_.least)};
}

std::vector<std::string> GrainEvolution::news() {
    std::vector<std::string> found = simulation_->take_notes();
    if (overlap_.is_due()) found.push_back(overlap_note(time(), overlap_.greatest()));
    if (step_share_.is_due())
        found.push_back(
            pressed_note(time(), simulation_->time_step() / step_share_.greatest(), overlap_of_stable_step_));
    return found;
}

ReadCheckpoint GrainEvolution::read(const std::filesystem::path& what,
                                    const std::filesystem::path& output_folder) {
    const auto began = std::chrono::steady_clock::now();
    ReadCheckpoint found{find_checkpoint(comm_, what, output_folder), {}, 0};
    ParticleSet grains = empty_grains(setup_.simulation);
    ParticleSet contacts = dem::empty_contacts(3, GrainSimulation::history_fields(setup_.simulation));
    std::vector<ParticleSet*> sets{&grains, &contacts};
    if (has_bonds()) {
        grains.add(field::broken_bonds);
        read_bonds_ = dem::empty_pairs("bonds", 3, dem::BondList::fields());
        sets.push_back(&*read_bonds_);
    }
    found.state = read_checkpoint(comm_, found.file, sets);
    if (const std::vector<std::string> wanted = materials(); found.state.materials != wanted)
        throw AgreedError(exit_input_output,
                          fmt::format("{}: is of grains of {}, this scene has {}", found.file.string(),
                                      fmt::join(found.state.materials, ", "), fmt::join(wanted, ", ")));
    if (const std::vector<std::string> wanted = names_of_walls(setup_.simulation.walls);
        found.state.walls != wanted)
        throw AgreedError(
            exit_input_output,
            fmt::format("{}: is of a scene with {}, this one has {}; what grains remember of walls goes "
                        "by their order",
                        found.file.string(), listed(found.state.walls), listed(wanted)));
    check_shear(found);
    simulation_.emplace(comm_, setup_.simulation, std::move(grains));
    read_contacts_ = std::move(contacts);
    found.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    return found;
}

void GrainEvolution::resume(const RunState& state) {
    simulation_->resume(state.time, state.step, state.numbers, *read_contacts_,
                        read_bonds_ ? &*read_bonds_ : nullptr);
    read_contacts_.reset();
    read_bonds_.reset();
}

std::vector<std::string> GrainEvolution::materials() const {
    std::vector<std::string> names;
    for (const GrainBody& body : setup_.bodies) names.push_back(body.material.name);
    return names;
}

void GrainEvolution::step() {
    do simulation_->step();
    while (!simulation_->is_synchronous());
}

void GrainEvolution::save(const WriteSets& write) {
    const ParticleSet contacts = simulation_->save();
    std::vector<const ParticleSet*> sets{&simulation_->grains(), &contacts};
    std::optional<ParticleSet> bonds;
    if (has_bonds()) sets.push_back(&bonds.emplace(simulation_->saved_bonds()));
    write(sets);
}

/// Where images across y stand follows from the number of steps.
void GrainEvolution::check_shear(const ReadCheckpoint& found) const {
    const auto stored = found.state.numbers.find("sheared_in_a_step");
    const double then = stored == found.state.numbers.end() ? 0 : stored->second,
                 now = sheared_in_a_step(setup_.simulation);
    if (then != now)
        throw AgreedError(
            exit_input_output,
            fmt::format("{}: its box was sheared by {} in a time step, that of this scene is by {}; "
                        "neither box.shear_rate nor the time step may change",
                        found.file.string(), then, now));
}

void GrainEvolution::describe(RunState& state) const {
    state.materials = materials();
    state.walls = names_of_walls(setup_.simulation.walls);
    if (const double sheared = sheared_in_a_step(setup_.simulation); sheared != 0)
        state.numbers["sheared_in_a_step"] = sheared;
    simulation_->save_numbers(state.numbers);
    if (simulation_->clumps().exists()) state.numbers["clumps"] = 1;
}

std::vector<SnapshotField> GrainEvolution::snapshot_fields() const {
    std::vector<SnapshotField> fields;
    for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
             &field::velocity, &field::angular_velocity, &field::radius, &field::mass, &field::body})
        fields.push_back({.field = info});
    if (has_bonds()) fields.push_back({.field = &field::broken_bonds});
    return fields;
}

std::vector<SnapshotSet> GrainEvolution::more_snapshots() {
    if (!setup_.write_contacts) return {};
    std::vector<SnapshotSet> sets;
    sets.push_back({contact_set(simulation_->loaded_contacts(), simulation_->grains()), contact_fields()});
    return sets;
}

/// Where an axis is periodic, places are not unique, and torques neither.
bool GrainEvolution::torques_have_meaning() const {
    const auto& boundaries = setup_.simulation.box.boundary;
    return std::find(boundaries.begin(), boundaries.end(), Boundary::periodic) == boundaries.end();
}

std::vector<CsvColumn> GrainEvolution::diagnostics_columns() const {
    std::vector<CsvColumn> columns = {{"time", "s"},
                                      {"mass", "kg"},
                                      {"kinetic_energy", "J"},
                                      {"rotational_energy", "J"},
                                      {"potential_energy", "J"},
                                      {"momentum_x", "kg m s-1"},
                                      {"momentum_y", "kg m s-1"},
                                      {"momentum_z", "kg m s-1"},
                                      {"greatest_speed", "m s-1"},
                                      {"greatest_overlap", "1"},
                                      {"contacts", "1"},
                                      {"wall_contacts", "1"},
                                      {"coordination", "1"}};
    if (has_bonds()) columns.insert(columns.end(), {{"bonds", "1"}, {"broken_bonds", "1"}});
    if (knows_angular_momentum(setup_))
        for (const char axis : {'x', 'y', 'z'})
            columns.push_back({fmt::format("angular_momentum_{}", axis), "kg m2 s-1"});
    for (const dem::Wall& wall : setup_.simulation.walls)
        for (const char axis : {'x', 'y', 'z'})
            columns.push_back({fmt::format("force_{}_{}", wall.name, axis), "N"});
    if (torques_have_meaning())
        for (const dem::Wall& wall : setup_.simulation.walls)
            for (const char axis : {'x', 'y', 'z'})
                columns.push_back({fmt::format("torque_{}_{}", wall.name, axis), "N m"});
    append_flow_columns(setup_.simulation.flow, columns);
    std::vector<std::string> bodies;
    for (const GrainBody& body : setup_.bodies) bodies.push_back(body.name);
    append_region_columns(setup_.regions, bodies, columns);
    return columns;
}

Diagnostics GrainEvolution::diagnostics() {
    const GrainTotals t = simulation_->totals();
    overlap_.see(t.greatest_overlap);
    step_share_.see(simulation_->time_step() / t.stable_step);
    overlap_of_stable_step_ = t.overlap_of_stable_step;
    std::vector<double> row = {simulation_->time(),
                               t.mass,
                               t.kinetic_energy,
                               t.rotational_energy,
                               t.potential_energy,
                               t.momentum[0],
                               t.momentum[1],
                               t.momentum[2],
                               t.greatest_speed,
                               t.greatest_overlap,
                               static_cast<double>(t.contacts),
                               static_cast<double>(t.wall_contacts),
                               t.coordination};
    if (has_bonds())
        row.insert(row.end(), {static_cast<double>(t.bonds), static_cast<double>(t.broken_bonds)});
    if (knows_angular_momentum(setup_))
        row.insert(row.end(), t.angular_momentum.begin(), t.angular_momentum.end());
    for (const auto& force : t.wall_forces) row.insert(row.end(), force.begin(), force.end());
    if (torques_have_meaning())
        for (const auto& torque : t.wall_torques) row.insert(row.end(), torque.begin(), torque.end());
    append_flow_values(simulation_->flow(), t.grains, row);
    if (setup_.regions.empty()) return {row, 0};
    const auto wants_stress = [](const WatchedRegion& region) { return region.stress; };
    std::vector<dem::LoadedContact> contacts;
    if (std::any_of(setup_.regions.begin(), setup_.regions.end(), wants_stress))
        contacts = simulation_->loaded_contacts();
    const GrainSimulation& now = *simulation_;
    append_region_values(setup_.regions,
                         region_states(comm_, now.grains(), now.setup().box, now.clumps(),
                                       setup_.bodies.size(), setup_.regions, contacts),
                         row);
    return {row, 0};
}

std::string GrainEvolution::summary() const {
    const GrainTotals t = simulation_->totals();
    return fmt::format(
        "{} contacts of grains, {} at walls, {:.3f} grains touch each that is not held; greatest overlap "
        "{:.2g} of the radius; pairs listed {} times",
        t.contacts, t.wall_contacts, t.coordination, t.greatest_overlap, simulation_->list_count());
}

std::string GrainEvolution::performance() const {
    return fmt::format("\"lists\": {}, \"list_bytes_of_a_rank\": {}, ", simulation_->list_count(),
                       comm_.all_max(simulation_->bytes_of_lists()));
}

}  // namespace talus
