#include <gtest/gtest.h>

#include <cmath>

#include "physics/sph/pair_terms.hpp"
#include "tests/support/exact_riemann.hpp"

namespace talus {
namespace {

using reference::ExactRiemann, reference::GasState;

double sound_speed(const GasState& gas, double gamma) {
    return std::sqrt(gamma * gas.pressure / gas.density);
}

sph::RiemannSolution<double> solved(const GasState& left, const GasState& right, double gamma) {
    const auto side = [gamma](const GasState& gas) {
        return sph::RiemannSide<double>{gas.density, gas.pressure, gas.velocity, sound_speed(gas, gamma)};
    };
    return sph::solve_riemann(side(left), side(right), 0.5 * (gamma + 1));
}

struct Problem {
    const char* name;
    double gamma;
    GasState left, right;    ///< density, velocity, pressure
    double pressure_within;  ///< of the exact pressure [1]
    double velocity_within;  ///< of the greater sound speed [1]
};

// What one iteration on impedances of second order is off by, of gases: tolerances are the errors found,
// rounded up to two digits, so that a worse solver fails. Pairs of neighbours are mostly weak problems; the
// dissipation of strong ones rests on the pressure, which comes out too low. Strong problems: E. F. Toro,
// Riemann Solvers and Numerical Methods for Fluid Dynamics, 3rd ed., table 4.1, tests 1, 3, 4 and 5.
TEST(Riemann, IsAsCloseToTheExactSolutionAsStated) {
    const Problem problems[] = {
        {"jump of 5 %", 1.4, {1, 0, 1}, {1, 0, 1.05}, 7.2e-8, 5.1e-8},
        {"weak shocks", 1.4, {1, 0.05, 1}, {1, -0.05, 1}, 4.5e-7, 1e-15},
        {"weak rarefactions", 1.4, {1, -0.05, 1}, {1, 0.05, 1}, 1.6e-6, 1e-15},
        {"shock of 10, gamma 5/3", 5.0 / 3, {1, 0, 10}, {1, 0, 1}, 2.1e-3, 1.9e-3},
        {"rarefactions", 1.4, {1, -0.5, 1}, {1, 0.5, 1}, 1e-2, 1e-15},
        {"shocks of Mach 1.8", 1.4, {1, 1, 1}, {1, -1, 1}, 1.6e-2, 1e-15},
        {"Toro 1, Sod", 1.4, {1, 0, 1}, {0.125, 0, 0.1}, 8.2e-3, 3.1e-2},
        {"Sod, gamma 5/3", 5.0 / 3, {1, 0, 1}, {0.125, 0, 0.1}, 1.8e-2, 1.4e-2},
        {"Toro 3", 1.4, {1, 0, 1000}, {1, 0, 0.01}, 4e-3, 1.8e-2},
        {"Toro 4", 1.4, {1, 0, 0.01}, {1, 0, 100}, 3.8e-3, 1.7e-2},
        {"Toro 5", 1.4, {5.99924, 19.5975, 460.894}, {5.99242, -6.19633, 46.0950}, 8.5e-2, 2.3e-2},
        {"cold collision, gamma 5/3", 5.0 / 3, {1, 1, 1e-6}, {1, -1, 1e-6}, 0.3, 1e-15},
    };
    for (const Problem& problem : problems) {
        SCOPED_TRACE(problem.name);
        const ExactRiemann exact(problem.left, problem.right, problem.gamma);
        const auto found = solved(problem.left, problem.right, problem.gamma);
        const double fastest =
            std::max(sound_speed(problem.left, problem.gamma), sound_speed(problem.right, problem.gamma));
        EXPECT_NEAR(found.pressure, exact.star_pressure(), problem.pressure_within * exact.star_pressure());
        EXPECT_NEAR(found.velocity, exact.star_velocity(), problem.velocity_within * fastest);
    }
}

// Both waves count as shocks: third order in their strength, so half of it makes an eighth of the error.
TEST(Riemann, ErrsInThirdOrderOfTheStrengthOfRarefactions) {
    double errors[2];
    for (int k = 0; k < 2; ++k) {
        const double speed = 0.0125 / (k + 1);
        const GasState left{1, -speed, 1}, right{1, speed, 1};
        errors[k] =
            std::abs(solved(left, right, 1.4).pressure - ExactRiemann(left, right, 1.4).star_pressure());
    }
    EXPECT_NEAR(errors[0] / errors[1], 8, 0.5);
}

TEST(Riemann, EqualSidesAreTheirOwnSolution) {
    const GasState gas{2, 3, 5};
    EXPECT_DOUBLE_EQ(solved(gas, gas, 1.4).pressure, 5);
    EXPECT_DOUBLE_EQ(solved(gas, gas, 1.4).velocity, 3);
}

// Rarefactions that nearly tear a vacuum open (Toro 2): the pressure, which should be 0.0019, comes out low
// and negative, but small next to the gas's own. The pair loop takes the mean pressure then.
TEST(Riemann, StaysSmallNearVacuum) {
    const auto found = solved({1, -2, 0.4}, {1, 2, 0.4}, 1.4);
    EXPECT_NEAR(found.pressure, 0, 0.2 * 0.4);
    EXPECT_NEAR(found.velocity, 0, 1e-15);
}

// The pressure to the last bit, on which the conservation of momentum rests.
TEST(Riemann, Mirrors) {
    const GasState left{1, 0.3, 1}, right{0.125, -0.2, 0.1};
    const auto one = solved(left, right, 1.4);
    const auto other = solved({0.125, 0.2, 0.1}, {1, -0.3, 1}, 1.4);
    EXPECT_EQ(one.pressure, other.pressure);
    EXPECT_EQ(one.velocity, -other.velocity);
}

}  // namespace
}  // namespace talus
