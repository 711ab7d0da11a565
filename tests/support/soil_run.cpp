#include "tests/support/soil_run.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

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

double band_angle(const Communicator& comm, const SoilSimulation& simulation) {
    const ParticleSet& soil = simulation.particles();
    std::vector<double> mine;
    for (const std::size_t i : soil_nodes(soil)) {
        const double x = soil.data(field::position, 0)[i], y = soil.data(field::position, 1)[i];
        if (x > 0.15 && x < 0.6 && y > 0.72 && y < 1.6)
            mine.insert(mine.end(), {x, y, soil.data(soil_field::viscoplastic_strain)[i]});
    }
    const std::vector<double> all = comm.all_gather(std::span<const double>(mine));
    double most = 0;
    for (std::size_t k = 2; k < all.size(); k += 3) most = std::max(most, all[k]);
    double w = 0, wx = 0, wy = 0, wxx = 0, wxy = 0, wyy = 0;
    for (std::size_t k = 0; k < all.size(); k += 3) {
        const double x = all[k], y = all[k + 1], s = all[k + 2] - 0.3 * most;
        if (s <= 0) continue;
        w += s;
        wx += s * x;
        wy += s * y;
        wxx += s * x * x;
        wxy += s * x * y;
        wyy += s * y * y;
    }
    const double xx = wxx - wx * wx / w, xy = wxy - wx * wy / w, yy = wyy - wy * wy / w;
    return 0.5 * std::atan2(2 * xy, xx - yy) * 180 / std::numbers::pi;
}

}  // namespace talus::test
