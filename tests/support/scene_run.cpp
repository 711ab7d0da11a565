#include "tests/support/scene_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "src/run/commands.hpp"
#include "src/setup/scene_setup.hpp"
#include "tests/support/by_id.hpp"

namespace talus::test {

namespace {

double total_energy(const Simulation& simulation) { return simulation.totals().total_energy(); }

GasResult gathered(const Communicator& comm, const Simulation& simulation) {
    const ParticleSet& particles = simulation.particles();
    const ById by_id(comm, particles);
    GasResult result{};
    result.time = simulation.time();
    result.steps = simulation.step_count();
    result.x = by_id(particles.own(field::position, 0));
    result.v = by_id(particles.own(field::velocity, 0));
    result.density = by_id(particles.own(field::predicted_density));
    result.pressure = by_id(particles.own(field::pressure));
    const std::vector<double> mass = by_id(particles.own(field::mass));
    for (std::size_t k = 0; k < mass.size(); ++k) result.volume.push_back(mass[k] / result.density[k]);
    result.across.assign(mass.size(), 0);
    for (int axis = 1; axis < particles.dimension(); ++axis) {
        const std::vector<double> v = by_id(particles.own(field::velocity, axis));
        for (std::size_t k = 0; k < v.size(); ++k) result.across[k] = std::hypot(result.across[k], v[k]);
    }
    return result;
}

}  // namespace

double GasResult::mean_error(const std::function<double(std::size_t)>& error, double low, double high) const {
    double sum = 0, total = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        if (!(low < x[k] && x[k] < high)) continue;
        sum += std::abs(error(k)) * volume[k];
        total += volume[k];
    }
    return sum / total;
}

GasResult run_gas(const Communicator& comm, const std::filesystem::path& scene,
                  const std::vector<std::string>& overrides) {
    RunOptions options;
    options.scene = scene;
    options.overrides = overrides;
    const SceneSetup setup = read_scene(comm, load_scene(comm, options));
    Simulation simulation(comm, setup.simulation, make_particles(comm, setup));
    simulation.start();
    const double at_start = total_energy(simulation);
    double drift = 0, least = std::numeric_limits<double>::infinity();
    while (simulation.time() < setup.output.end_time) {
        simulation.step();
        const auto energy = std::as_const(simulation).particles().own(field::internal_energy);
        for (const double u : energy) least = std::min(least, u);
        if (simulation.step_count() % 10 == 0)
            drift = std::max(drift, std::abs(total_energy(simulation) / at_start - 1));
    }
    GasResult result = gathered(comm, simulation);
    result.energy_drift = std::max(drift, std::abs(total_energy(simulation) / at_start - 1));
    result.least_energy = comm.all_min(least);
    return result;
}

double order_of(double coarse, double fine) { return std::log2(coarse / fine); }

}  // namespace talus::test
