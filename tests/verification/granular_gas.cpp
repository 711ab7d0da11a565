#include "tests/support/granular_gas.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/gathered.hpp"

/// A gas of smooth inelastic spheres that cools by its collisions.
namespace talus::test {
namespace {

double temperature_of(const GrainSimulation& run) {
    const GrainTotals totals = run.totals();
    return 2 * totals.kinetic_energy / (3 * totals.mass);
}

/// The gas after elastic collisions have given it the distribution of places and velocities of equilibrium.
ParticleSet equilibrium(const Communicator& comm, GranularGas gas) {
    gas.restitution = 1;
    std::vector<GrainState> grains = gas.lattice();
    heat(grains, 1);
    GrainSimulation run(comm, gas.setup(), grain_set(comm, grains));
    run.start();
    while (run.time() < 3) run.step();  // about five collisions a grain
    run.save();
    ParticleSet settled("grains", 3);
    GrainSimulation::add_fields(settled);
    const GatheredState state = gather_state(comm, run.grains());
    fill(settled, state, [&](std::size_t k) {
        return k % static_cast<std::size_t>(comm.size()) == static_cast<std::size_t>(comm.rank());
    });
    return settled;
}

struct Cooling {
    std::vector<double> time, temperature;
};

Cooling cool(const GranularGas& gas, double duration) {
    const Communicator world(MPI_COMM_WORLD);
    GrainSimulation run(world, gas.setup(), equilibrium(world, gas));
    run.start();
    Cooling found;
    for (int k = 0; k <= 60; ++k) {
        while (run.time() < duration * k / 60) run.step();
        found.time.push_back(run.time());
        found.temperature.push_back(temperature_of(run));
    }
    const GrainTotals totals = run.totals();
    EXPECT_LT(std::hypot(totals.momentum[0], totals.momentum[1], totals.momentum[2]), 1e-9);
    return found;
}

/// Slope of the straight line of least squares.
double slope(const std::vector<double>& x, const std::vector<double>& y) {
    double mean_x = 0, mean_y = 0, xy = 0, xx = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        mean_x += x[k] / static_cast<double>(x.size());
        mean_y += y[k] / static_cast<double>(x.size());
    }
    for (std::size_t k = 0; k < x.size(); ++k) {
        xy += (x[k] - mean_x) * (y[k] - mean_y);
        xx += (x[k] - mean_x) * (x[k] - mean_x);
    }
    return xy / xx;
}

class HaffsLaw : public testing::TestWithParam<double> {};

TEST_P(HaffsLaw, Cools) {
    const GranularGas gas{10, 0.1, GetParam(), 0.01};
    const double e = GetParam(), phi = gas.volume_fraction;
    const double density = 6 * phi / std::numbers::pi;  // grains a volume
    const double g = (1 - phi / 2) / std::pow(1 - phi, 3);
    const double collisions = 4 * density * g * std::sqrt(std::numbers::pi);  // of a grain in unit time
    const double tau = 6 / ((1 - e * e) * collisions);
    const Cooling found = cool(gas, 3 * tau);
    std::vector<double> root, log_time, log_temperature;
    for (std::size_t k = 0; k < found.time.size(); ++k) {
        const double ratio = found.temperature[k] / found.temperature[0];
        root.push_back(1 / std::sqrt(ratio));
        log_time.push_back(std::log(1 + found.time[k] / tau));
        log_temperature.push_back(std::log(ratio));
    }
    // P. K. Haff, J. Fluid Mech. 134 (1983) 401; rate of collisions: N. F. Carnahan, K. E. Starling, J. Chem.
    // Phys. 51 (1969) 635. Collisions that last press the spheres in, to (1 - 0.45 contact_time sqrt(pi T))
    // of their diameter as they count: 1.2 % of tau; the velocities' deviation from Maxwell's adds 0.3 %. One
    // gas of 1000 grains scatters by 1.5 % in tau and by 0.02 in the exponent (twelve runs): three times
    // that.
    EXPECT_NEAR(1 / slope(found.time, root), 1.015 * tau, 0.05 * tau);
    EXPECT_NEAR(slope(log_time, log_temperature), -2, 0.06);
}

INSTANTIATE_TEST_SUITE_P(Restitution, HaffsLaw, testing::Values(0.8, 0.9));

}  // namespace
}  // namespace talus::test
