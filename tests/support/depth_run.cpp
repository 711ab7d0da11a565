#include "tests/support/depth_run.hpp"

#include <algorithm>
#include <cmath>

#include "domain/depth_fields.hpp"
#include "src/run/commands.hpp"
#include "tests/support/by_id.hpp"

namespace talus::test {

double DepthResult::mean_error(const std::function<double(std::size_t)>& error, double low,
                               double high) const {
    double sum = 0, total = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        if (!(low < x[k] && x[k] < high)) continue;
        sum += std::abs(error(k)) * volume[k];
        total += volume[k];
    }
    return sum / total;
}

DepthScene depth_scene(const Communicator& comm, const std::filesystem::path& scene,
                       const std::vector<std::string>& overrides) {
    RunOptions options;
    options.scene = scene;
    options.overrides = overrides;
    return read_depth_scene(comm, load_scene(comm, options));
}

DepthResult run_depth(const Communicator& comm, const DepthScene& scene) {
    DepthSimulation simulation(comm, scene.simulation, make_columns(comm, scene));
    simulation.start();
    DepthResult result{};
    result.first = simulation.totals();
    while (simulation.time() < scene.output.end_time) {
        simulation.step();
        result.greatest_speed = std::max(result.greatest_speed, simulation.totals().greatest_speed);
    }
    result.last = simulation.totals();
    result.time = simulation.time();
    result.steps = simulation.step_count();
    const ParticleSet& particles = simulation.particles();
    const ById by_id(comm, particles);
    result.x = by_id(particles.own(field::position, 0));
    result.u = by_id(particles.own(field::velocity, 0));
    result.depth = by_id(particles.own(field::depth));
    result.volume = by_id(particles.own(field::volume));
    if (particles.dimension() == 1) {
        result.y = result.v = std::vector<double>(result.x.size(), 0);
    } else {
        result.y = by_id(particles.own(field::position, 1));
        result.v = by_id(particles.own(field::velocity, 1));
    }
    return result;
}

}  // namespace talus::test
