#include <fmt/format.h>

#include <array>
#include <chrono>
#include <numbers>
#include <string_view>

#include "src/run/commands.hpp"
#include "src/run/scene_checks.hpp"
#include "src/run/warnings.hpp"
#include "src/setup/scene_setup.hpp"

namespace talus {

namespace {

void print_fields(const ParticleSet& particles) {
    fmt::print("\nfields ({} bytes per particle):\n", particles.bytes_per_particle());
    for (const Column& column : particles.columns()) {
        const std::size_t bytes = column.components.size() * column.value_size();
        fmt::print("  {:>4} B  {:<24} {:<7} {:<6} {}\n", bytes, column.info->name,
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

int check_scene(const Communicator& comm, const RunOptions& options) {
    const Scene scene = load_scene(comm, options);
    const SceneSetup setup = read_scene(comm, scene);
    check_plan(scene, setup, setup.output.end_time);
    Simulation simulation(comm, setup.simulation, make_particles(comm, setup));
    check_box(scene, simulation);
    simulation.start();
    const double first_step = simulation.time_step();
    const auto largest = comm.all_max(static_cast<std::uint64_t>(simulation.particles().size()));
    const auto largest_halo = comm.all_max(static_cast<std::uint64_t>(simulation.particles().halo_size()));
    const double seconds = measured_step_seconds(simulation);
    if (!comm.is_root()) return exit_done;

    fmt::print("{}\n\n{}\n", setup.title, scene.resolved());
    print_bodies(setup);
    if (setup.impact) print_impact(*setup.impact, setup);
    fmt::print("equations of state:\n");
    for (const Material& material : setup.simulation.materials) print_scan(material);
    for (const std::string& warning : warnings(setup)) fmt::print("note: {}\n", warning);
    print_fields(simulation.particles());
    const double bytes = static_cast<double>(simulation.particles().bytes_per_particle());
    const double steps = setup.output.end_time / first_step;
    fmt::print("\nparticles: {} on {} ranks, at most {} own and {} copies on a rank, {:.3g} MB of fields\n",
               simulation.total_particles(), comm.size(), largest, largest_halo,
               bytes * static_cast<double>(largest + largest_halo) / 1e6);
    fmt::print("first time step: {:.4g} s (limited by {} at particle {}); about {:.0f} steps to {} s\n",
               first_step, simulation.step_limit().reason, simulation.step_limit().id, steps,
               setup.output.end_time);
    fmt::print("estimated cost: {:.3g} s a step on {} ranks, {:.3g} minutes in all\n", seconds, comm.size(),
               seconds * steps / 60);
    return exit_done;
}

}  // namespace talus
