#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "comm/exact_sum.hpp"
#include "tests/support/coupled_run.hpp"
#include "tests/support/root_of.hpp"

/// Grains that settle, blocks of them under flow and fluidised beds against balances of their forces.
namespace talus::test {
namespace {

const std::filesystem::path runs = std::filesystem::path(TALUS_SOURCE_DIR) / "runs";
constexpr double gravity = 9.81, glass = 2500;

struct Liquid {
    double density, viscosity;
};
constexpr Liquid air{1.1839, 1.86e-5}, water{1000, 8.9e-4}, glycerol{1150, 8.9e-3};

double ball(double diameter) { return std::numbers::pi / 6 * diameter * diameter * diameter; }

/// Drag on one grain at the slip of the interstitial liquid [N].
double drag(const coupling::DragLaw& law, coupling::PressureModel model, const Liquid& liquid,
            double fraction, double diameter, double slip) {
    return slip * coupling::drag_coefficient(law, model, {liquid.density, liquid.viscosity, fraction},
                                             diameter, slip);
}
using coupling::DiFelice;
using coupling::PressureModel;

/// Mean velocity between two times of a grain that falls from rest: weight, buoyancy and drag, by the
/// classical Runge-Kutta scheme.
double mean_fall(const Liquid& liquid, double diameter, double from, double until) {
    const double mass = glass * ball(diameter), weight = (glass - liquid.density) * gravity * ball(diameter);
    const auto rate = [&](double v) {
        return (weight - drag(DiFelice{}, PressureModel::a, liquid, 1, diameter, v)) / mass;
    };
    constexpr int steps = 20000;
    const double dt = until / steps;
    double v = 0, fall = 0;
    for (int k = 0; k < steps; ++k) {
        const double k1 = rate(v), k2 = rate(v + dt / 2 * k1), k3 = rate(v + dt / 2 * k2),
                     k4 = rate(v + dt * k3), next = v + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
        if ((k + 0.5) * dt > from) fall += 0.5 * dt * (v + next);
        v = next;
    }
    return fall / (until - from);
}

// A bead of a tenth of a millimetre, water four diameters apart: within 1 % of the solution of its equation
// of motion, as M. Robinson, M. Ramaioli, S. Luding, Int. J. Multiphase Flow 59 (2014) 121 find for water
// coarser than two diameters. In water it is at its terminal velocity after 0.01 s, in air it still speeds
// up.
TEST(CoupledBeds, SettlingInAirAndWater) {
    const Communicator world(MPI_COMM_WORLD);
    struct Case {
        const char* scene;
        Liquid liquid;
        double from, until;
    };
    for (const Case& c : {Case{"air.toml", air, 0.005, 0.025}, Case{"water.toml", water, 0.01, 0.05}}) {
        const CoupledScene scene = coupled_scene(world, runs / "settling_grain" / c.scene,
                                                 {fmt::format("run.end_time={}", c.until)});
        double begin = 0, since = 0, end = 0, height = 0;
        run_coupled(world, scene, [&](const CoupledSimulation& s) {
            end = s.water().time();
            height = s.totals().mean_place[2];
            if (end <= c.from) {
                begin = height;
                since = end;
            }
        });
        const double expected = mean_fall(c.liquid, 1e-4, since, end);
        EXPECT_NEAR((begin - height) / (end - since) / expected, 1, 0.01) << c.scene;
    }
}

/// Mass flux over the density between two heights: the diffusion of density carries some mass the other way
/// where the pressure rises outside of the grains, so that the mean over the box is not that in them.
double superficial_velocity(const Communicator& comm, const CoupledSimulation& simulation, double from,
                            double until) {
    const ParticleSet& liquid = simulation.water().particles();
    std::array<ExactSum, 2> sums;  // momentum and volume
    for (std::size_t a = 0; a < liquid.size(); ++a) {
        const double z = liquid.data(field::position, 2)[a], mass = liquid.data(field::mass)[a];
        if (z < from || z > until) continue;
        sums[0].add(mass * liquid.data(field::velocity, 2)[a]);
        sums[1].add(mass / liquid.data(field::density)[a]);
    }
    ExactSum::all_reduce(comm, sums);
    return sums[0].value() / (glycerol.density * sums[1].value());
}

/// Superficial velocity of a flow through a periodic column of length L, of which the lower part H is full of
/// grains, as the mean equations have it whose fractions and forces are spread over `reach` with Wendland's
/// function: the drive bears the drag on all grains, each at the fraction and slip spread to it.
double spread_block_velocity(const coupling::DragLaw& law, const Liquid& liquid, double diameter,
                             double solid, double reach, double length, double height, double drive) {
    constexpr int n = 800;
    const double dz = length / n;
    const int wide = static_cast<int>(reach / dz);
    std::vector<double> weight(static_cast<std::size_t>(2 * wide + 1));  // of planes: 21/R int_q q w(q) dq
    double sum = 0;
    for (int k = -wide; k <= wide; ++k) {
        double& w = weight[static_cast<std::size_t>(k + wide)];
        const double least = std::abs(k) * dz / reach;
        constexpr int parts = 200;
        for (int i = 0; i < parts; ++i) {
            const double q = least + (i + 0.5) / parts * (1 - least);
            w += q * std::pow(1 - q, 4) * (1 + 4 * q) * (1 - least) / parts;
        }
        sum += w;
    }
    const auto spread = [&](const std::vector<double>& from) {
        std::vector<double> to(n, 0.0);
        for (int z = 0; z < n; ++z)
            for (int k = -wide; k <= wide; ++k)
                to[static_cast<std::size_t>(z)] += weight[static_cast<std::size_t>(k + wide)] / sum *
                                                   from[static_cast<std::size_t>((z + k + n) % n)];
        return to;
    };
    std::vector<double> block(n, 0.0);
    for (int z = 0; z < n; ++z)
        if ((z + 0.5) * dz < height) block[static_cast<std::size_t>(z)] = solid;
    const std::vector<double> around = spread(block), at_grains = spread(around);
    std::vector<double> inverse(n), force(n);
    for (std::size_t z = 0; z < n; ++z) inverse[z] = 1 / (1 - around[z]);
    const std::vector<double> slip = spread(inverse);
    return root_of(
        [&](double velocity) {
            for (std::size_t z = 0; z < n; ++z)
                force[z] = block[z] == 0 ? 0.0
                                         : block[z] / ball(diameter) *
                                               drag(law, PressureModel::a, liquid, 1 - at_grains[z], diameter,
                                                    velocity * slip[z]);
            const std::vector<double> on_liquid = spread(force);
            double borne = 0;
            for (std::size_t z = 0; z < n; ++z) borne += on_liquid[z] * inverse[z] * dz;
            return borne - liquid.density * drive * length;
        },
        0, 1);
}

// A block of grains as porous as it is long, under a drive that would bear its weight: the velocity is that
// of the mean equations spread over the averaging length, to 2 % (a lattice of twenty layers, six spacings of
// water across). The spreading opens its ends: it is faster than through a block with sharp ones.
TEST(CoupledBeds, PorousBlock) {
    const Communicator world(MPI_COMM_WORLD);
    constexpr double diameter = 1e-3, fraction = 0.7, height = 24.0798e-3, reach = 6e-3,
                     drive = 1.727413;  // as in the scene
    const CoupledScene scene = coupled_scene(world, runs / "porous_block", {"run.end_time=0.06"});
    double found = 0;
    run_coupled(world, scene, [&](const CoupledSimulation& s) {
        if (s.water().step_count() % 20 == 0)
            found = superficial_velocity(world, s, 0.2 * height, 0.8 * height);
    });
    const double spread =
        spread_block_velocity(DiFelice{}, glycerol, diameter, 1 - fraction, reach, 2 * height, height, drive);
    const double slip = root_of(
        [&](double w) {
            return drag(DiFelice{}, PressureModel::b, glycerol, fraction, diameter, w) -
                   ball(diameter) * gravity * (glass - glycerol.density);
        },
        0, 1);
    EXPECT_NEAR(found / spread, 1, 0.02);
    EXPECT_GT(found, fraction * slip);
}

struct BedState {
    double height = 0;    ///< mean of the beads that move [m]
    double velocity = 0;  ///< superficial, of the liquid [m/s]
    double borne = 0;     ///< by the liquid, of the weight less buoyancy [1]
};

/// Beads in columns on a plate in a narrow periodic box: state at the start and mean over the later half.
std::array<BedState, 2> fluidised(const std::string& law, double drive, double until) {
    const Communicator world(MPI_COMM_WORLD);
    const CoupledScene scene = coupled_scene(
        world, runs / "fluidised_bed",
        {"box.upper=[0.008,0.008,0.032]", "grains[0].upper=[0.008,0.008,0.004]",
         "grains[1].upper=[0.008,0.008,0.016]", fmt::format("water.gravity=[0,0,{}]", drive),
         fmt::format("dem.gravity=[0,0,{:.17g}]", -gravity + glycerol.density / glass * (gravity + drive)),
         fmt::format("coupling.drag={}", law), fmt::format("run.end_time={}", until)});
    const double volume = 8 * 8 * 12 * ball(1e-3);  // of the beads that move
    std::array<BedState, 2> states;
    int count = 0;
    run_coupled(world, scene, [&](const CoupledSimulation& s) {
        const CouplingTotals t = s.totals();
        if (s.water().time() == 0) states[0].height = t.mean_place[2];
        if (s.water().time() < until / 2) return;
        BedState& mean = states[1];
        mean.height += t.mean_place[2];
        mean.velocity += superficial_velocity(world, s, 4e-3, 12e-3);
        mean.borne += (t.force[2] - t.held_force[2] + glycerol.density * drive * volume) /
                      ((glass - glycerol.density) * gravity * volume);
        ++count;
    });
    for (double BedState::*of : {&BedState::height, &BedState::velocity, &BedState::borne})
        states[1].*of /= count;
    return states;
}

// Below the velocity of fluidisation the beads stand as they stood, and bear of their weight what the liquid
// does not; its velocity is that of the mean equations to 5 % (Ergun's law, plate and bed as one block of the
// fraction of columns). Above, the liquid bears all of the weight, to 2 %, and the bed rises.
TEST(CoupledBeds, Fluidisation) {
    const double columns = 1 - std::numbers::pi / 6;
    const auto [lying, still] = fluidised("ergun", 1.5, 0.06);
    EXPECT_NEAR(still.height, lying.height, 1e-4);
    EXPECT_LT(still.borne, 0.8);
    EXPECT_NEAR(still.velocity / spread_block_velocity(coupling::Ergun{}, glycerol, 1e-3, 1 - columns, 5e-3,
                                                       32e-3, 16e-3, 1.5),
                1, 0.05);
    const auto [packed, risen] = fluidised("ergun", 3.5, 0.12);
    EXPECT_NEAR(risen.borne, 1, 0.02);
    EXPECT_GT(risen.height, packed.height + 3e-4);
}

}  // namespace
}  // namespace talus::test
