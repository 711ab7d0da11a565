#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "domain/grain_fields.hpp"
#include "src/run/families.hpp"
#include "src/run/grain_evolution.hpp"
#include "src/run/options.hpp"

namespace talus {

int check_grain_scene(const Communicator& comm, const Scene& scene) {
    GrainEvolution evolution(comm, scene, {});
    evolution.create({});
    constexpr int blocks = 5;
    const auto began = std::chrono::steady_clock::now();
    for (int k = 0; k < blocks; ++k) evolution.step();
    const double seconds =
        comm.all_max(std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count()) /
        static_cast<double>(evolution.step_count());
    const GrainScene& setup = evolution.setup();
    std::vector<std::uint64_t> counts(setup.bodies.size());
    for (const std::uint8_t body : evolution.particles().own(field::body)) ++counts[body];
    comm.all_sum(std::span<std::uint64_t>(counts));
    const std::uint64_t lists = comm.all_sum(evolution.simulation().bytes_of_lists());
    if (!comm.is_root()) return exit_done;

    fmt::print("{}\n\n{}\n", setup.title, scene.resolved());
    for (std::size_t b = 0; b < setup.bodies.size(); ++b) {
        const GrainBody& body = setup.bodies[b];
        fmt::print("grains {}: {} of {}, radius {:.4g} to {:.4g} m{}\n", body.name, counts[b],
                   body.material.name, body.least_radius, body.greatest_radius,
                   body.held ? ", held" : (body.inserted ? ", inserted as time goes on" : ""));
    }
    for (const std::string& warning : evolution.warnings()) fmt::print("note: {}\n", warning);
    const auto total = static_cast<double>(std::max<std::uint64_t>(evolution.total_particles(), 1));
    fmt::print("\ngrains: {} on {} ranks, {} bytes each in fields, {:.0f} in pairs, contacts and forces\n",
               evolution.total_particles(), comm.size(), evolution.particles().bytes_per_particle(),
               static_cast<double>(lists) / total);
    const double all_steps = setup.output.end_time / setup.simulation.time_step;
    fmt::print("time step: {:.4g} s, at most {:.4g} s ({}); {:.0f} steps to {} s\n",
               setup.simulation.time_step, setup.greatest_time_step, setup.time_step_limit,
               std::ceil(all_steps), setup.output.end_time);
    fmt::print("estimated cost: {:.3g} s a step on {} ranks, {:.3g} minutes in all\n", seconds, comm.size(),
               seconds * all_steps / 60);
    return exit_done;
}

}  // namespace talus
