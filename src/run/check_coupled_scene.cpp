#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "src/run/coupled_evolution.hpp"
#include "src/run/families.hpp"
#include "src/run/options.hpp"

namespace talus {

int check_coupled_scene(const Communicator& comm, const Scene& scene) {
    CoupledEvolution evolution(comm, scene, {});
    evolution.create({});
    evolution.start();
    const double first_step = evolution.time_step();
    const auto began = std::chrono::steady_clock::now();
    evolution.step();
    const double seconds =
        comm.all_max(std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
    const CoupledSimulation& simulation = evolution.simulation();
    const CouplingTotals totals = simulation.totals();
    if (!comm.is_root()) return exit_done;

    const CoupledScene& setup = evolution.setup();
    fmt::print("{}\n\n{}\n", evolution.title(), scene.resolved());
    for (const std::string& warning : evolution.warnings()) fmt::print("note: {}\n", warning);
    fmt::print(
        "water and its walls: {} particles, spacing {:.4g} m; {} grains, up to {:.4g} m across; {} ranks\n",
        simulation.water().total_particles(), setup.water.spacing, simulation.grains().total_grains(),
        setup.greatest_diameter, comm.size());
    fmt::print("grains are spread over {:.4g} m and leave at least {:.3g} of the volume to the water\n",
               setup.coupling.spreading.radius, totals.least_fluid_fraction);
    if (setup.grains.simulation.settling)
        fmt::print("grains settle before the start, which is not counted below\n");
    const double steps = setup.water.output.end_time / first_step;
    fmt::print("first time step: {:.4g} s, {} of the grains; {:.0f} such steps to {} s\n", first_step,
               std::lround(first_step / simulation.grains().time_step()), std::ceil(steps),
               setup.water.output.end_time);
    fmt::print("estimated cost: {:.3g} s a step, {:.3g} minutes for so many steps\n", seconds,
               seconds * steps / 60);
    return exit_done;
}

}  // namespace talus
