#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <string_view>

#include "io/progress.hpp"
#include "src/run/families.hpp"
#include "src/run/options.hpp"
#include "src/run/scene_checks.hpp"
#include "src/run/warnings.hpp"
#include "src/setup/scene_setup.hpp"

namespace talus {

namespace {

void print_fields(const ParticleSet& particles, const Setup& setup) {
    const std::vector<NeededField> needed = needed_fields(setup);
    fmt::print("\nfields ({} bytes per particle), which model asks for them, what they are:\n",
               particles.bytes_per_particle());
    for (const Column& column : particles.columns()) {
        const auto why = std::find_if(needed.begin(), needed.end(),
                                      [&](const NeededField& one) { return one.info == column.info; });
        const std::size_t bytes = column.components.size() * column.value_size();
        fmt::print("  {:>4} B  {:<24} {:<25} {:<6} {:<6} {}\n", bytes, column.info->name,
                   why == needed.end() ? "every set" : why->model,
                   column.info->role == Role::state ? "state" : "work",
                   column.info->reach == Reach::halo ? "copied" : "", column.info->description);
    }
}

void print_bodies(const SceneSetup& setup) {
    const int dimension = setup.simulation.box.dimension;
    constexpr std::array<std::string_view, 3> volume_unit{"m", "m2", "m3"}, mass_unit{"kg/m2", "kg/m", "kg"};
    for (std::size_t b = 0; b < setup.bodies.size(); ++b) {
        const Body& body = setup.bodies[b];
        const BodyCensus& census = setup.census[b];
        const auto last_axis = static_cast<std::size_t>(dimension - 1);
        fmt::print(
            "body {}: {} particles of {}, spacing {:.4g} m, volume {:.6g} {}, mass {:.6g} {} ({:.4g} "
            "each)\n",
            body.name, census.count, setup.simulation.materials[b].name, body.spacing,
            volume(body.shape, dimension), volume_unit[last_axis], census.mass, mass_unit[last_axis],
            census.mass / static_cast<double>(census.count));
        if (const double spin = norm(body.spin); spin > 0) {
            fmt::print("  turns in {:.4g} s, {:.4g} h", rotation_period(spin), rotation_period(spin) / 3600);
            if (dimension == 3)
                fmt::print(", {:.4g} of the spin that breaks up a sphere",
                           spin / break_up_spin(body.density, setup.gravitational_constant));
            fmt::print("\n");
        }
    }
}

void print_impact(const Impact& impact, const SceneSetup& setup) {
    fmt::print(
        "impact: {} hits {} at {:.6g} m/s and {:.4g} deg from head-on, centres {:.6g} m apart, impact "
        "parameter "
        "{:.6g} m\n",
        setup.bodies[impact.plan.impactor].name, setup.bodies[impact.plan.target].name, impact.contact.speed,
        impact.contact.angle * 180 / std::numbers::pi, impact.contact.distance, impact.impact_parameter);
    fmt::print("  starts {:.6g} m apart at {:.6g} m/s\n", norm(impact.start.position),
               norm(impact.start.velocity));
    fmt::print("  specific energy {:.6g} J/kg of all, {:.6g} J/kg of the target\n", impact.specific_energy,
               impact.energy_per_target);
    if (setup.simulation.box.dimension < 3) return;
    fmt::print("  mutual escape speed {:.6g} m/s: impact at {:.4g} of it, {:.6g} m/s at infinity\n",
               impact.escape_speed, impact.contact.speed / impact.escape_speed, impact.speed_at_infinity);
}

/// Memory of the largest rank, measured.
struct Memory {
    double before_particles, after_a_step;  ///< [bytes]
};

void print_memory(const Memory& memory, const ParticleSet& particles, std::uint64_t own,
                  std::uint64_t copies) {
    std::size_t copied = 0;
    for (const Column& column : particles.columns())
        if (column.info->reach == Reach::halo) copied += column.components.size() * column.value_size();
    const double fields = static_cast<double>(own * particles.bytes_per_particle() + copies * copied);
    const double buffers = std::max(0.0, memory.after_a_step - memory.before_particles - fields);
    fmt::print(
        "memory of the largest rank after a step, without files: {:.1f} MB; the program itself {:.1f} MB, "
        "fields of {} own "
        "particles and {} copies {:.1f} MB, buffers of the loops and messages {:.1f} MB\n",
        memory.after_a_step / 1e6, memory.before_particles / 1e6, own, copies, fields / 1e6, buffers / 1e6);
}

/// Looks through the equation of state's plane where it can be unphysical.
void print_scan(const Material& material) {
    const auto* tillotson = std::get_if<Tillotson>(&material.eos);
    if (!tillotson) return;
    const ScanResult result = scan(*tillotson);
    fmt::print("  {}: c^2 < 0 in {} of {} states of its (density, energy) plane", material.name,
               result.imaginary, result.points);
    if (result.imaginary > 0)
        fmt::print(", none denser than {:.3g} kg/m3 ({:.2f} of rest); the floor of c acts there",
                   result.densest_imaginary, result.densest_imaginary / tillotson->reference_density);
    fmt::print("\n");
}

double measured_step_seconds(Simulation& simulation) {
    const auto began = std::chrono::steady_clock::now();
    simulation.step();
    return simulation.comm().all_max(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
}

}  // namespace

int check_sph_scene(const Communicator& comm, const Scene& scene) {
    const SceneSetup setup = read_scene(comm, scene);
    check_plan(scene, setup, setup.output.end_time);
    Memory memory{static_cast<double>(comm.all_max(peak_memory())), 0};
    Simulation simulation(comm, setup.simulation, make_particles(comm, setup));
    check_box(scene, simulation);
    simulation.start();
    const double first_step = simulation.time_step();
    const auto largest = comm.all_max(static_cast<std::uint64_t>(simulation.particles().size()));
    const auto largest_halo = comm.all_max(static_cast<std::uint64_t>(simulation.particles().halo_size()));
    const double seconds = measured_step_seconds(simulation);
    memory.after_a_step = static_cast<double>(comm.all_max(peak_memory()));
    if (!comm.is_root()) return exit_done;

    fmt::print("{}\n\n{}\n", setup.title, scene.resolved());
    print_bodies(setup);
    if (setup.impact) print_impact(*setup.impact, setup);
    fmt::print("equations of state:\n");
    for (const Material& material : setup.simulation.materials) print_scan(material);
    for (const std::string& warning : warnings(setup)) fmt::print("note: {}\n", warning);
    print_fields(simulation.particles(), setup.simulation);
    if (setup.settle) fmt::print("\nbodies settle before the start, which is not counted below\n");
    const double steps = setup.output.end_time / first_step;
    fmt::print("\nparticles: {} on {} ranks\n", simulation.total_particles(), comm.size());
    print_memory(memory, simulation.particles(), largest, largest_halo);
    fmt::print(
        "first time step: {:.4g} s (limited by {} at particle {}); {:.0f} such steps to {} s, more if "
        "matter is compressed, heated or torn\n",
        first_step, simulation.step_limit().reason, simulation.step_limit().id, std::ceil(steps),
        setup.output.end_time);
    fmt::print("estimated cost: {:.3g} s a step on {} ranks, {:.3g} minutes for so many steps\n", seconds,
               comm.size(), seconds * steps / 60);
    return exit_done;
}

}  // namespace talus
