#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "physics/coupling/exchange.hpp"
#include "tests/support/sphere_release.hpp"

namespace talus::test {
namespace {

using namespace coupling;

// The error that the class states, a thousandth; found 7.5e-4.
TEST(HistoryKernel, IsTheRootToAThousandth) {
    for (const double longest : {1e-4, 1e-2, 1.0, 1e3}) {
        const HistoryKernel kernel(1e-5, longest);
        double worst = 0;
        for (double t = 1e-5; t < longest; t *= 1.01)
            worst = std::max(worst, std::abs(kernel(t) * std::sqrt(t) - 1));
        EXPECT_LT(worst, 1e-3) << longest;
    }
    EXPECT_LE(HistoryKernel(1e-5, 10).size(), 16);
}

// A slip that grows evenly for 2 s and then stays: the integral over the root of the time since is
// 2 (sqrt(t) - sqrt(t - 2)) from then on, in steps of any length.
TEST(HistoryKernel, RemembersARamp) {
    const HistoryKernel kernel(0.01, 100);
    std::vector<double> memories(static_cast<std::size_t>(kernel.size()));
    double time = 0, last = 0, change = 0;
    for (int k = 0; time < 20; ++k) {
        const double next = k % 3 == 0 ? 0.02 : 0.01;
        const HistoryKernel::Passage passage = kernel.between(last, next);
        double found = passage.recent * change;
        for (std::size_t j = 0; j < memories.size(); ++j) {
            found += passage.memories[j].felt * passage.memories[j].kept * memories[j];
            memories[j] = passage.memories[j].kept * memories[j] + passage.memories[j].taken * change;
        }
        const auto mean_root = [&](double since) {  // of 2 sqrt(t - since) over the step
            return 4 / (3 * next) * (std::pow(time + next - since, 1.5) - std::pow(time - since, 1.5));
        };
        if (time > 2.05) {
            EXPECT_NEAR(found / (mean_root(0) - mean_root(2)), 1, 1e-3) << time;
        }
        change = std::clamp(2 - time, 0.0, next);
        time += next;
        last = next;
    }
}

/// Velocities of a sphere that falls from rest under Stokes drag, virtual mass and Basset's force, over the
/// terminal one, after the steps `lengths` [s].
std::vector<double> falling(const SphereRelease& sphere, const std::vector<double>& lengths) {
    constexpr double fluid_density = 1000, gravity = 9.81;
    double all = 0, shortest = lengths.front();
    for (const double step : lengths) {
        all += step;
        shortest = std::min(shortest, step);
    }
    ExchangeLaws laws{.drag = Stokes{}, .viscosity = sphere.viscosity * fluid_density, .virtual_mass = 0.5};
    laws.basset.emplace(shortest, all);
    const double volume = std::numbers::pi / 6 * std::pow(sphere.diameter, 3);
    const Gathered around{.velocity = {},
                          .vorticity = {},
                          .force_density = {0, 0, fluid_density * gravity},
                          .acceleration = {},
                          .reaction = {},
                          .solid_fraction = 0,
                          .density = fluid_density,
                          .crowding = 0};
    const double mass = sphere.density_ratio * fluid_density * volume;
    MovingGrain grain{sphere.diameter / 2, mass, false, {}, {}, {0, 0, -gravity}};
    std::vector<double> memories(static_cast<std::size_t>(laws.basset->size()));
    const double terminal = -(mass - fluid_density * volume) * gravity /
                            (3 * std::numbers::pi * laws.viscosity * sphere.diameter);
    double last = 0, slip = 0;
    std::vector<double> found;
    for (const double next : lengths) {
        const HistoryKernel::Passage passage = laws.basset->between(last, next);
        const double change = -grain.velocity.z - slip;
        grain.remembered.z = passage.recent * change;
        for (std::size_t j = 0; j < memories.size(); ++j) {
            const auto& [kept, taken, felt] = passage.memories[j];
            grain.remembered.z += felt * kept * memories[j];
            memories[j] = kept * memories[j] + taken * change;
        }
        slip = -grain.velocity.z;
        const dem::Vector3<> force = mean_force(laws, grain, around, 1, next);
        grain.velocity += next * (grain.other_acceleration + (1 / mass) * force);
        found.push_back(grain.velocity.z / terminal);
        last = next;
    }
    return found;
}

/// From 0.8 relaxation times on.
double worst_error(const SphereRelease& sphere, const std::vector<double>& lengths) {
    const std::vector<double> found = falling(sphere, lengths);
    double time = 0, worst = 0;
    for (std::size_t k = 0; k < lengths.size(); ++k) {
        time += lengths[k];
        if (time > 0.799 * sphere.relaxation_time() && (k % 4 == 3 || lengths.size() < 100))
            worst = std::max(worst, std::abs(found[k] - sphere.velocity(time)));
    }
    return worst;
}

// The two forms of the exact solution agree where both hold.
TEST(History, ExactSolutionOfASphereReleased) {
    for (const double ratio : {0.1, 0.5}) {
        const SphereRelease sphere{.diameter = 1e-3, .viscosity = 1e-5, .density_ratio = ratio};
        for (const double time : {1e-5, 1e-3, 0.1})
            EXPECT_NEAR(sphere.velocity(time), sphere.closed_velocity(time), 1e-6) << ratio << ' ' << time;
    }
}

// A light, a buoyant, a sand and a heavy grain for twenty relaxation times T. The slip is taken to change
// evenly within a step, which at the start it does not, as its third derivative there is infinite: found 5e-4
// at steps of T/20 and 2.3e-2 at 0.8 T, with orders of 1.4 to 2.
TEST(History, SphereReleasedFromRest) {
    for (const double ratio : {0.1, 0.5, 2.5, 8.0}) {
        const SphereRelease sphere{.diameter = 1e-3, .viscosity = 1e-5, .density_ratio = ratio};
        const double relaxation = sphere.relaxation_time();
        const auto steps = [&](int count) {
            return std::vector<double>(static_cast<std::size_t>(count), 20 * relaxation / count);
        };
        const double coarse = worst_error(sphere, steps(100)), fine = worst_error(sphere, steps(400));
        EXPECT_LT(worst_error(sphere, steps(25)), 0.03) << ratio;
        EXPECT_LT(fine, 1e-3) << ratio;
        EXPECT_GT(std::log(coarse / fine) / std::log(4), 1.3) << ratio;
        std::vector<double> uneven = steps(400);
        for (std::size_t k = 0; k < uneven.size(); ++k) uneven[k] *= k % 7 < 3 ? 0.5 : 1;
        EXPECT_LT(worst_error(sphere, uneven), 1e-3) << ratio;
    }
}

// Steps of up to a million relaxation times do not ring: what is left to the terminal velocity is never more
// than after the first step, where it is as much as Basset's force of one jump at the start, d/2
// (pi nu t)^(-1/2), to a fifth.
TEST(History, StiffStepsStayBounded) {
    const SphereRelease sphere{.diameter = 1e-3, .viscosity = 1e-5, .density_ratio = 2.5};
    for (const double steps : {10.0, 1e3, 1e6}) {
        const std::vector<double> found =
            falling(sphere, std::vector<double>(60, steps * sphere.relaxation_time()));
        const double left = 0.5 * sphere.diameter /
                            std::sqrt(std::numbers::pi * sphere.viscosity * steps * sphere.relaxation_time());
        for (const double v : found) EXPECT_NEAR(v, 1, 1.2 * left);
        EXPECT_NEAR(found.back(), sphere.velocity(60 * steps * sphere.relaxation_time()), 1e-3);
    }
}

}  // namespace
}  // namespace talus::test
