#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "src/run/families.hpp"
#include "src/run/options.hpp"
#include "src/run/water_evolution.hpp"

namespace talus {

int check_water_scene(const Communicator& comm, const Scene& scene) {
    WaterEvolution evolution(comm, scene, {});
    evolution.create({});
    evolution.start();
    const double first_step = evolution.time_step();
    const auto began = std::chrono::steady_clock::now();
    evolution.step();
    const double seconds =
        comm.all_max(std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
    const WaterTotals totals = evolution.simulation().totals();
    if (!comm.is_root()) return exit_done;

    const WaterScene& setup = evolution.setup();
    const water::Settings& settings = setup.simulation.settings;
    fmt::print("{}\n\n{}\n", setup.title, scene.resolved());
    for (const std::string& warning : evolution.warnings()) fmt::print("note: {}\n", warning);
    fmt::print("water: {:.6g} kg, {} particles of it and {} of walls on {} ranks, {} bytes each in fields\n",
               totals.mass, totals.particles, evolution.total_particles() - totals.particles, comm.size(),
               evolution.particles().bytes_per_particle());
    fmt::print("spacing {:.4g} m, kernel ends at {:.4g} m, sound {:.4g} m/s\n", setup.spacing,
               settings.radius(), settings.state.sound_speed);
    if (const auto& mud = settings.rheology)
        fmt::print(
            "mud: viscosity up to {:.4g} Pa s, whose steps are at most {:.4g} s; below the yield stress it "
            "creeps at less than {:.3g} 1/s\n",
            mud->greatest_viscosity, settings.viscous_time_step(), mud->creep_rate());
    if (const RigidBodies* rigid = evolution.simulation().rigid())
        for (std::size_t k = 0; k < rigid->count(); ++k) {
            const rigid::Body& body = rigid->body(k);
            fmt::print("rigid body '{}': {:.6g} kg, {} particles, {:.3g} across, {} contact spheres\n",
                       body.name, body.mass, setup.census[body.index].count,
                       setup.particles_across(body.index), body.spheres.size());
        }
    const double steps = setup.output.end_time / first_step;
    fmt::print("first time step: {:.4g} s (limited by {} at particle {}); {:.0f} such steps to {} s\n",
               first_step, evolution.simulation().step_limit().reason, evolution.simulation().step_limit().id,
               std::ceil(steps), setup.output.end_time);
    fmt::print("estimated cost: {:.3g} s a step on {} ranks, {:.3g} minutes for so many steps\n", seconds,
               comm.size(), seconds * steps / 60);
    return exit_done;
}

}  // namespace talus
