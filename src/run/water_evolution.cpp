#include "src/run/water_evolution.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "domain/water_fields.hpp"
#include "io/checkpoint.hpp"
#include "src/run/options.hpp"
#include "src/run/scene_checks.hpp"

namespace talus {

WaterEvolution::WaterEvolution(const Communicator& comm, const Scene& scene, std::optional<double> until)
    : comm_(comm),
      scene_(scene),
      setup_(read_water_scene(comm, scene)),
      end_time_(until.value_or(setup_.output.end_time)),
      record_(setup_.simulation, setup_.body_names(), setup_.gauges),
      speed_(most_speed_of_water * setup_.simulation.settings.state.sound_speed) {
    check_snapshots(scene, setup_.output, end_time_);
    refuse_short_box(scene, setup_.simulation.box, setup_.simulation.settings.radius());
}

void WaterEvolution::emplace(ParticleSet particles) {
    simulation_.emplace(comm_, setup_.simulation, std::move(particles));
}

void WaterEvolution::create(const std::function<void()>&) { emplace(make_water(comm_, setup_)); }

ReadCheckpoint WaterEvolution::read(const std::filesystem::path& what,
                                    const std::filesystem::path& output_folder) {
    const auto began = std::chrono::steady_clock::now();
    ReadCheckpoint found{find_checkpoint(comm_, what, output_folder), {}, 0};
    ParticleSet particles = empty_water(setup_.simulation), states = RigidBodies::empty_states(),
                contacts = RigidBodies::empty_contacts(setup_.simulation.rigid);
    std::vector<ParticleSet*> sets{&particles};
    const bool has_rigid = !setup_.simulation.rigid.bodies.empty();
    if (has_rigid) sets.insert(sets.end(), {&states, &contacts});
    found.state = read_checkpoint(comm_, found.file, sets);
    RunState wanted;
    describe(wanted);
    if (found.state.materials != wanted.materials)
        throw AgreedError(
            exit_input_output,
            fmt::format("{}: is of the bodies {}; this scene has {}", found.file.string(),
                        fmt::join(found.state.materials, ", "), fmt::join(wanted.materials, ", ")));
    emplace(std::move(particles));
    if (has_rigid) simulation_->rigid()->restore(states, contacts);
    found.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    return found;
}

void WaterEvolution::start() {
    constexpr double most_overlap = 0.2;
    if (const RigidBodies* rigid = simulation_->rigid()) {
        const rigid::Contacts::Overlap found = simulation_->rigid()->greatest_overlap(0);
        if (found.share > most_overlap)
            scene_.root().error(
                "body",
                fmt::format("rigid body '{}' overlaps '{}' at the start, by {:.3g} of the radius of their "
                            "contact spheres; allowed: {}",
                            rigid->body(found.body).name, found.with, found.share, most_overlap));
        scene_.finish();
    }
    simulation_->start();
    core_warnings_ = core_warnings(*simulation_);
}

std::vector<std::string> WaterEvolution::warnings() const {
    std::vector<std::string> found = water_warnings(setup_);
    found.insert(found.end(), core_warnings_.begin(), core_warnings_.end());
    return found;
}

void WaterEvolution::save(const WriteSets& write) {
    const RigidBodies* rigid = simulation_->rigid();
    if (!rigid) return write({&simulation_->particles()});
    const ParticleSet states = rigid->saved_states(), contacts = rigid->saved_contacts();
    write({&simulation_->particles(), &states, &contacts});
}

void WaterEvolution::describe(RunState& state) const {
    for (std::size_t b = 0; b < setup_.bodies.size(); ++b) {
        const bool is_wall = !setup_.simulation.walls.empty() && setup_.simulation.walls[b];
        const auto& ends = setup_.simulation.open.buffers;
        const char* what = is_wall ? "wall" : "water";
        if (!ends.empty() && ends[b].is_open())
            what = ends[b].kind == water::Buffer::Kind::inflow ? "inflow" : "outflow";
        for (const rigid::Body& body : setup_.simulation.rigid.bodies)
            if (body.index == b) what = "rigid body";
        state.materials.push_back(fmt::format("{} ({})", setup_.bodies[b].name, what));
    }
    if (simulation_) simulation_->save_numbers(state.numbers);
}

std::vector<std::string> WaterEvolution::news() {
    if (OpenBoundaries* open = simulation_->open())
        if (std::vector<std::string> notes = open->take_notes(); !notes.empty()) return notes;
    if (!speed_.is_due()) return {};
    return {speed_note(time(), speed_.greatest(), setup_.simulation.settings.state.sound_speed)};
}

std::vector<SnapshotField> WaterEvolution::snapshot_fields() const {
    std::vector<SnapshotField> fields;
    for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
             &field::velocity, &field::mass, &field::density, &field::pressure, &field::body})
        fields.push_back({.field = info});
    if (setup_.simulation.settings.rheology) fields.push_back({.field = &water_field::viscosity});
    return fields;
}

/// Of a rigid body.
void WaterEvolution::add_columns_of(const std::string& name, std::vector<CsvColumn>& columns) const {
    const std::string axes = setup_.simulation.box.dimension == 2 ? "xy" : "xyz",
                      turns = axes == "xy" ? "z" : "xyz";
    const auto add = [&](const char* what, const std::string& along, const char* unit) {
        for (const char axis : along) columns.push_back({fmt::format("{}_{}_{}", name, what, axis), unit});
    };
    add("centre", axes, "m");
    add("velocity", axes, "m s-1");
    add("turning", turns, "rad s-1");
    add("force", axes, "N");
    add("torque", turns, "N m");
    columns.push_back({name + "_kinetic_energy", "J"});
    columns.push_back({name + "_potential_energy", "J"});
}

void WaterEvolution::add_row_of(const RigidTotals& body, std::vector<double>& row) const {
    const bool flat = setup_.simulation.box.dimension == 2;
    const auto add = [&](const dem::Vector3<>& v, bool turns) {
        if (flat && turns)
            row.push_back(v.z);
        else if (flat)
            row.insert(row.end(), {v.x, v.y});
        else
            row.insert(row.end(), {v.x, v.y, v.z});
    };
    add(body.state.centre, false);
    add(body.state.velocity, false);
    add(body.turning, true);
    add(body.force, false);
    add(body.torque, true);
    row.insert(row.end(), {body.kinetic_energy, body.potential_energy});
}

std::vector<CsvColumn> WaterEvolution::diagnostics_columns() const {
    std::vector<CsvColumn> columns{{"time", "s"},
                                   {"time_step", "s"},
                                   {"mass", "kg"},
                                   {"kinetic_energy", "J"},
                                   {"potential_energy", "J"},
                                   {"elastic_energy", "J"},
                                   {"greatest_speed", "m s-1"},
                                   {"least_density", "kg m-3"},
                                   {"greatest_density", "kg m-3"},
                                   {"least_pressure", "Pa"},
                                   {"greatest_pressure", "Pa"}};
    for (int a = 0; a < setup_.simulation.box.dimension; ++a) {
        const char axis = "xyz"[a];
        columns.push_back({fmt::format("momentum_{}", axis), "kg m s-1"});
        columns.push_back({fmt::format("least_{}", axis), "m"});
        columns.push_back({fmt::format("greatest_{}", axis), "m"});
    }
    for (CsvColumn& column : record_.columns()) columns.push_back(std::move(column));
    if (const RigidBodies* rigid = simulation_->rigid())
        for (std::size_t k = 0; k < rigid->count(); ++k) add_columns_of(rigid->body(k).name, columns);
    return columns;
}

Diagnostics WaterEvolution::diagnostics() {
    const WaterTotals t = simulation_->totals();
    speed_.see(t.greatest_speed);
    Diagnostics found{
        {time(), time_step(), t.mass, t.kinetic_energy, t.potential_energy, t.elastic_energy,
         t.greatest_speed, t.least_density, t.greatest_density, t.least_pressure, t.greatest_pressure},
        0};
    for (std::size_t a = 0; a < static_cast<std::size_t>(setup_.simulation.box.dimension); ++a)
        found.row.insert(found.row.end(), {t.momentum[a], t.least_place[a], t.greatest_place[a]});
    record_.measure(*simulation_, found.row);
    if (const RigidBodies* rigid = simulation_->rigid())
        for (std::size_t k = 0; k < rigid->count(); ++k) add_row_of(rigid->totals(k), found.row);
    return found;
}

std::string WaterEvolution::summary() const {
    const WaterTotals t = simulation_->totals();
    return fmt::format("water: {:.6g} kg, densities from {:.6g} to {:.6g} kg/m3, greatest speed {:.4g} m/s",
                       t.mass, t.least_density, t.greatest_density, t.greatest_speed);
}

}  // namespace talus
