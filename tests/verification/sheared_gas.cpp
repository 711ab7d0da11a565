#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tests/support/granular_gas.hpp"

/// Inelastic spheres in a box that is sheared for ever.
namespace talus::test {
namespace {

constexpr std::size_t slabs = 8;

/// Grains of all ranks: x y z, velocity of the image within the box.
using Row = std::array<double, 6>;
std::vector<Row> gather(const GrainSimulation& run) {
    const ParticleSet& grains = run.grains();
    std::vector<Row> mine(grains.size());
    for (std::size_t i = 0; i < mine.size(); ++i)
        for (int axis = 0; axis < 3; ++axis) {
            const auto a = static_cast<std::size_t>(axis);
            mine[i][a] = grains.data(field::position, axis)[i];
            mine[i][3 + a] = grains.data(field::velocity, axis)[i];
        }
    return run.comm().all_gather(std::span<const Row>(mine));
}

/// Averages of a steady flow.
struct Flow {
    double stress = 0;       ///< -P_xy: of motion relative to the flow, and of contacts (A. E. H. Love)
    double pressure = 0;     ///< a third of the trace
    double dissipation = 0;  ///< of the dashpots, over the volume
    double heating = 0;      ///< growth of the kinetic energy, over the volume
    double temperature = 0;
    std::array<double, slabs> velocity{}, count{};
};

/// Adds the contacts of one moment, found and evaluated independently of the code under test.
void add_contacts(const GranularGas& gas, double rate, double time, std::vector<Row> grains, Flow& flow) {
    const double edge = gas.edge(), offset = std::fmod(rate * edge * time, edge);
    for (Row& row : grains) {
        const double turns = std::floor(row[1] / edge);
        row[0] -= turns * offset;
        row[1] -= turns * edge;
    }
    const double k = gas.stiffness(), c = gas.damping(), volume = edge * edge * edge;
    for (std::size_t i = 0; i < grains.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const Row &a = grains[i], &b = grains[j];
            const double turns = std::round((a[1] - b[1]) / edge);
            const double y = a[1] - b[1] - turns * edge, z = std::remainder(a[2] - b[2], edge);
            if (y * y + z * z > 1) continue;
            const double x = std::remainder(a[0] - b[0] - turns * offset, edge);
            const double distance = std::sqrt(x * x + y * y + z * z);
            if (distance > 1) continue;
            const double closing =
                -((a[3] - b[3] - turns * rate * edge) * x + (a[4] - b[4]) * y + (a[5] - b[5]) * z) / distance;
            const double force = k * (1 - distance) + c * closing;
            flow.stress -= force * x * y / distance / volume;
            flow.pressure += force * distance / 3 / volume;
            flow.dissipation += c * closing * closing / volume;
        }
}

Flow shear(const GranularGas& gas, double rate) {
    const Communicator world(MPI_COMM_WORLD);
    GrainSetup setup = gas.setup();
    setup.box.shear_rate = rate;
    std::vector<GrainState> grains = gas.lattice();
    heat(grains, 0.8 * rate * rate);
    for (GrainState& grain : grains) grain.velocity.x += dem::shear_flow(setup.box, grain.position.y);
    GrainSimulation run(world, setup, grain_set(world, grains));
    run.start();
    while (run.time() < 8 / rate) run.step();
    Flow flow;
    const double volume = gas.edge() * gas.edge() * gas.edge(), duration = 25 / rate;
    const auto energy = [&] { return run.totals().kinetic_energy; };
    const double begin = run.time(), energy_before = energy();
    constexpr int samples = 2500;
    for (int s = 0; s < samples; ++s) {
        while (run.time() < begin + duration * (s + 1) / samples) run.step();
        const std::vector<Row> rows = gather(run);
        for (const Row& row : rows) {
            const double ux = row[3] - dem::shear_flow(setup.box, row[1]);
            flow.stress -= ux * row[4] / volume;
            flow.temperature += (ux * ux + row[4] * row[4] + row[5] * row[5]) / 3 / gas.number();
            const double height = row[1] / gas.edge() - std::floor(row[1] / gas.edge());
            const auto slab = std::min(static_cast<std::size_t>(height * slabs), slabs - 1);
            flow.velocity[slab] += row[3];
            flow.count[slab] += 1;
        }
        add_contacts(gas, rate, run.time(), rows, flow);
    }
    for (double* mean : {&flow.stress, &flow.pressure, &flow.dissipation, &flow.temperature})
        *mean /= samples;
    flow.pressure += flow.temperature * gas.number() / volume;
    for (std::size_t s = 0; s < slabs; ++s) flow.velocity[s] /= flow.count[s];
    for (const double momentum : run.totals().momentum)
        EXPECT_LT(std::abs(momentum), 1e-7 * rate * gas.number());
    flow.heating = (energy() - energy_before) / duration / volume;
    return flow;
}

/// The flow is steady and even, and the power of the shear stress is what the dashpots dissipate. Contacts
/// are a sample of some 15 000, which scatters by 1 to 2 %, as does the temperature of 512 grains.
void expect_steady(const GranularGas& gas, double rate, const Flow& flow) {
    EXPECT_NEAR(flow.stress * rate, flow.dissipation + flow.heating, 0.05 * flow.dissipation);
    // Pressure of the gas at this temperature: C. K. K. Lun et al., J. Fluid Mech. 140 (1984) 223, with the
    // density at contact of N. F. Carnahan, K. E. Starling, J. Chem. Phys. 51 (1969) 635.
    const double phi = gas.volume_fraction, g = (1 - phi / 2) / std::pow(1 - phi, 3);
    const double thermal = gas.number() / std::pow(gas.edge(), 3) * flow.temperature;
    EXPECT_NEAR(flow.pressure, thermal * (1 + 2 * (1 + gas.restitution) * phi * g), 0.05 * flow.pressure);
    // A slab's 64 grains move with sqrt(T), about the rate: 1/8 at one moment, a fifth of that over 25 /
    // rate.
    for (std::size_t s = 0; s < slabs; ++s) {
        const double middle = (static_cast<double>(s) + 0.5) / slabs - 0.5;
        EXPECT_NEAR(flow.velocity[s], rate * gas.edge() * middle, 0.1 * rate) << "slab " << s;
    }
}

/// R. A. Bagnold, Proc. R. Soc. A 225 (1954) 49: grains as good as rigid know no time but that of the shear.
TEST(ShearedGas, StressGrowsAsTheSquareOfTheRate) {
    const GranularGas gas{8, 0.2, 0.8, 0.008};
    const Flow slow = shear(gas, 1), fast = shear(gas, 2);
    expect_steady(gas, 1, slow);
    expect_steady(gas, 2, fast);
    // Contacts last 0.8 and 1.6 % of the time of the shear.
    EXPECT_NEAR(fast.stress / slow.stress, 4, 0.2);
    EXPECT_NEAR(fast.pressure / slow.pressure, 4, 0.2);
}

}  // namespace
}  // namespace talus::test
