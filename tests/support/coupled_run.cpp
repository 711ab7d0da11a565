#include "tests/support/coupled_run.hpp"

#include "src/run/commands.hpp"

namespace talus::test {

CoupledScene coupled_scene(const Communicator& comm, const std::filesystem::path& scene,
                           const std::vector<std::string>& overrides) {
    RunOptions options;
    options.scene = scene;
    options.overrides = overrides;
    return read_coupled_scene(comm, load_scene(comm, options));
}

void run_coupled(const Communicator& comm, const CoupledScene& scene,
                 const std::function<void(const CoupledSimulation&)>& after) {
    CoupledSetup setup = scene.simulation();
    setup.grains.settling = scene.grains.simulation.settling;
    CoupledSimulation simulation(comm, setup, make_water(comm, scene.water), make_grains(comm, scene.grains));
    if (setup.grains.settling) simulation.settle([] {});
    simulation.start();
    after(simulation);
    while (simulation.water().time() < scene.water.output.end_time) {
        simulation.step();
        after(simulation);
    }
}

}  // namespace talus::test
