#include "src/run/soil_evolution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "domain/soil_fields.hpp"
#include "io/agree.hpp"
#include "io/checkpoint.hpp"

namespace talus {

SoilEvolution::SoilEvolution(const Communicator& comm, const Scene& scene, std::optional<double> until)
    : comm_(comm), setup_(read_soil_scene(comm, scene)), end_time_(until.value_or(setup_.output.end_time)) {}

void SoilEvolution::create(const std::function<void()>&) {
    simulation_.emplace(comm_, setup_.simulation, make_soil(comm_, setup_));
}

std::vector<std::string> SoilEvolution::materials() const {
    std::vector<std::string> names;
    for (const soil::Material& material : setup_.simulation.materials) names.push_back(material.name);
    return names;
}

std::vector<std::string> SoilEvolution::boundaries() const {
    std::vector<std::string> found;
    for (const soil::BoundaryCondition& condition : setup_.simulation.conditions)
        found.push_back(fmt::format("{} (kind {}, face {})", condition.name, static_cast<int>(condition.kind),
                                    condition.face));
    return found;
}

ReadCheckpoint SoilEvolution::read(const std::filesystem::path& what,
                                   const std::filesystem::path& output_folder) {
    const auto began = std::chrono::steady_clock::now();
    ReadCheckpoint found{find_checkpoint(comm_, what, output_folder), {}, 0};
    ParticleSet particles = empty_soil(setup_.simulation);
    found.state = read_checkpoint(comm_, found.file, {&particles});
    const auto refuse = [&](const std::string& why) {
        throw AgreedError(exit_input_output, fmt::format("{}: {}", found.file.string(), why));
    };
    if (found.state.materials != materials())
        refuse(fmt::format("is of soil of {}, this scene has {}", fmt::join(found.state.materials, ", "),
                           fmt::join(materials(), ", ")));
    if (found.state.walls != boundaries())
        refuse(fmt::format("is of a scene with the boundaries {}; this one has {}",
                           fmt::join(found.state.walls, ", "), fmt::join(boundaries(), ", ")));
    simulation_.emplace(comm_, setup_.simulation, std::move(particles));
    if (found.state.time_step != simulation_->time_step())
        refuse(
            fmt::format("has a time step of {} s, this scene one of {} s; neither stiffness nor "
                        "soil.spacing nor soil.courant may change",
                        found.state.time_step, simulation_->time_step()));
    found.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    return found;
}

void SoilEvolution::describe(RunState& state) const {
    state.materials = materials();
    state.walls = boundaries();
}

std::vector<SnapshotField> SoilEvolution::snapshot_fields() const {
    std::vector<SnapshotField> fields;
    for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
             &soil_field::grid, &soil_field::velocity, &soil_field::displacement, &soil_field::stress,
             &soil_field::lateral_stress, &soil_field::pore_pressure, &soil_field::viscoplastic_strain,
             &soil_field::preconsolidation, &field::mass, &field::body})
        if (particles().has(*info)) fields.push_back({.field = info});
    return fields;
}

std::vector<CsvColumn> SoilEvolution::diagnostics_columns() const {
    std::vector<CsvColumn> columns = {{"time", "s"},
                                      {"mass", "kg"},
                                      {"kinetic_energy", "J"},
                                      {"elastic_energy", "J"},
                                      {"viscoplastic_work", "J"},
                                      {"greatest_speed", "m s-1"},
                                      {"greatest_displacement", "m"},
                                      {"greatest_viscoplastic_strain", "1"},
                                      {"strength_factor", "1"}};
    if (setup_.simulation.saturated)
        columns.insert(
            columns.end(),
            {{"least_pore_pressure", "Pa"}, {"greatest_pore_pressure", "Pa"}, {"pressure_iterations", "1"}});
    const int dimension = setup_.simulation.dimension;
    for (int a = 0; a < dimension; ++a) columns.push_back({fmt::format("momentum_{}", "xyz"[a]), "kg m s-1"});
    constexpr std::array<const char*, 3> units = {"Pa", "N m-1", "N"};
    for (const soil::BoundaryCondition& condition : setup_.simulation.conditions)
        for (int a = 0; a < dimension && condition.face >= 0; ++a)
            columns.push_back({fmt::format("force_{}_{}", condition.name, "xyz"[a]),
                               units[static_cast<std::size_t>(dimension - 1)]});
    return columns;
}

Diagnostics SoilEvolution::diagnostics() {
    const SoilTotals t = simulation_->totals();
    std::vector<double> row = {time(),
                               t.mass,
                               t.kinetic_energy,
                               t.elastic_energy,
                               t.viscoplastic_work,
                               t.greatest_speed,
                               t.greatest_displacement,
                               t.greatest_viscoplastic_strain,
                               setup_.simulation.strength_factor(time())};
    if (setup_.simulation.saturated)
        row.insert(row.end(), {t.least_pore_pressure, t.greatest_pore_pressure,
                               static_cast<double>(simulation_->pressure_iterations())});
    const auto axes = static_cast<std::size_t>(setup_.simulation.dimension);
    row.insert(row.end(), t.momentum.begin(), t.momentum.begin() + static_cast<std::ptrdiff_t>(axes));
    for (std::size_t c = 0; c < t.forces.size(); ++c)
        for (std::size_t a = 0; a < axes && setup_.simulation.conditions[c].face >= 0; ++a)
            row.push_back(t.forces[c][a]);
    return {row, 0};
}

}  // namespace talus
