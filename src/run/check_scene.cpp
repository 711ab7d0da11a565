#include <fmt/format.h>

#include <chrono>

#include "src/run/commands.hpp"
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
    Simulation simulation(comm, setup.simulation, make_particles(comm, setup));
    simulation.start();
    const double first_step = simulation.time_step();
    const auto largest = comm.all_max(static_cast<std::uint64_t>(simulation.particles().size()));
    const auto largest_halo = comm.all_max(static_cast<std::uint64_t>(simulation.particles().halo_size()));
    const double seconds = measured_step_seconds(simulation);
    if (!comm.is_root()) return exit_done;

    fmt::print("{}\n\n{}\n", setup.title, scene.resolved());
    for (std::size_t b = 0; b < setup.bodies.size(); ++b)
        fmt::print("body {}: {} particles of {}, spacing {:.4g} m\n", setup.bodies[b].name,
                   count_particles(setup.bodies[b], setup.simulation.box.dimension),
                   setup.simulation.materials[b].name, setup.bodies[b].spacing);
    fmt::print("equations of state:\n");
    for (const Material& material : setup.simulation.materials) print_scan(material);
    for (const std::string& warning : warnings(setup.simulation)) fmt::print("note: {}\n", warning);
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
