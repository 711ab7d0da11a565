#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "domain/soil_fields.hpp"
#include "src/run/families.hpp"
#include "src/run/options.hpp"
#include "src/run/soil_evolution.hpp"

namespace talus {

int check_soil_scene(const Communicator& comm, const Scene& scene) {
    SoilEvolution evolution(comm, scene, {});
    evolution.create({});
    evolution.start();
    constexpr int steps = 5;
    const auto began = std::chrono::steady_clock::now();
    for (int k = 0; k < steps; ++k) evolution.step();
    const double seconds =
        comm.all_max(std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count()) / steps;
    std::uint64_t nodes = 0;
    for (const std::uint8_t grid : evolution.particles().own(soil_field::grid))
        nodes += grid == soil::node_grid;
    nodes = comm.all_sum(nodes);
    if (!comm.is_root()) return exit_done;

    const SoilScene& setup = evolution.setup();
    fmt::print("{}\n\n{}\n", setup.title, scene.resolved());
    for (std::size_t b = 0; b < setup.bodies.size(); ++b) {
        const soil::Material& material = setup.simulation.materials[b];
        fmt::print("body {}: {}, waves of compression at {:.4g} m/s\n", setup.bodies[b].name, material.name,
                   material.wave_speed());
    }
    fmt::print("\nnodes: {}, elements: {} on {} ranks, {} bytes each in fields\n", nodes,
               evolution.total_particles() - nodes, comm.size(), evolution.particles().bytes_per_particle());
    const double all_steps = setup.output.end_time / evolution.time_step();
    fmt::print("time step: {:.4g} s; {:.0f} steps to {} s\n", evolution.time_step(), std::ceil(all_steps),
               setup.output.end_time);
    fmt::print("estimated cost: {:.3g} s a step on {} ranks, {:.3g} minutes in all\n", seconds, comm.size(),
               seconds * all_steps / 60);
    return exit_done;
}

}  // namespace talus
