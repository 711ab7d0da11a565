#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "src/run/depth_evolution.hpp"
#include "src/run/families.hpp"
#include "src/run/options.hpp"
#include "src/run/rung_advice.hpp"

namespace talus {

int check_depth_scene(const Communicator& comm, const Scene& scene) {
    DepthEvolution evolution(comm, scene, {});
    evolution.create({});
    evolution.start();
    const double first_step = evolution.time_step();
    const DepthTotals start = evolution.simulation().totals();
    const auto began = std::chrono::steady_clock::now();
    evolution.step();
    const double seconds =
        comm.all_max(std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
    const DepthTotals totals = evolution.simulation().totals();
    if (!comm.is_root()) return exit_done;

    const DepthScene& setup = evolution.setup();
    fmt::print("{}\n\n{}\n", setup.title, scene.resolved());
    for (const std::string& warning : evolution.warnings()) fmt::print("note: {}\n", warning);
    fmt::print("flow: {:.6g} m3, {} particles on {} ranks, {} bytes each in fields\n", totals.volume,
               evolution.total_particles(), comm.size(), evolution.particles().bytes_per_particle());
    const double steps = setup.output.end_time / first_step;
    fmt::print("first time step: {:.4g} s (limited by {} at particle {}); {:.0f} such steps to {} s\n",
               first_step, evolution.simulation().step_limit().reason, evolution.simulation().step_limit().id,
               std::ceil(steps), setup.output.end_time);
    fmt::print("estimated cost: {:.3g} s a step on {} ranks, {:.3g} minutes for so many steps\n", seconds,
               comm.size(), seconds * steps / 60);
    fmt::print("cheapest model that serves: {}\n", rung_advice(setup, start));
    return exit_done;
}

}  // namespace talus
