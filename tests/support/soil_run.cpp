#include "tests/support/soil_run.hpp"

#include "domain/soil_fields.hpp"
#include "src/run/commands.hpp"

namespace talus::test {

SoilScene soil_scene(const Communicator& comm, const std::filesystem::path& scene,
                     const std::vector<std::string>& overrides, bool quick) {
    RunOptions options;
    options.scene = scene;
    options.quick = quick;
    options.overrides = overrides;
    return read_soil_scene(comm, load_scene(comm, options));
}

void run_soil(const Communicator& comm, const SoilScene& scene,
              const std::function<void(const SoilSimulation&)>& after) {
    SoilSimulation simulation(comm, scene.simulation, make_soil(comm, scene));
    simulation.start();
    after(simulation);
    while (simulation.time() < scene.output.end_time) {
        simulation.step();
        after(simulation);
    }
}

std::vector<std::size_t> soil_nodes(const ParticleSet& particles) {
    std::vector<std::size_t> nodes;
    const auto grid = particles.own(soil_field::grid);
    for (std::size_t i = 0; i < grid.size(); ++i)
        if (grid[i] == soil::node_grid) nodes.push_back(i);
    return nodes;
}

}  // namespace talus::test
