#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tests/support/sedov_taylor.hpp"

namespace talus::reference {
namespace {

// Kamm & Timmes 2007, table for the spherical standard case: alpha = 0.851072 for gamma = 1.4.
TEST(SedovTaylor, HasThePublishedEnergyIntegral) {
    EXPECT_NEAR(SedovTaylor(1, 1, 1.4).alpha(), 0.851072, 1e-6);
}

TEST(SedovTaylor, ShockJumpsAsRankineAndHugoniot) {
    const double gamma = 5.0 / 3, time = 0.3;
    const SedovTaylor blast(2, 3, gamma);
    const double radius = blast.shock_radius(time), speed = 0.4 * radius / time;
    const GasState behind = blast(radius * (1 - 1e-9), time);
    EXPECT_NEAR(behind.density, 12, 1e-5);
    EXPECT_NEAR(behind.velocity, 0.75 * speed, 1e-6 * speed);
    EXPECT_NEAR(behind.pressure, 0.75 * 3 * speed * speed, 1e-5 * speed * speed);
    EXPECT_EQ(blast(radius * 1.0001, time).velocity, 0);
}

// What the shock swept up is there, and so is the energy.
TEST(SedovTaylor, KeepsMassAndEnergy) {
    for (const double gamma : {1.4, 5.0 / 3}) {
        const SedovTaylor blast(1, 1, gamma);
        const double shock = blast.shock_radius(1);
        constexpr int n = 4000;
        double mass = 0, energy = 0;
        for (int k = 0; k < n; ++k) {
            const double r = shock * (k + 0.5) / n, shell = 4 * std::numbers::pi * r * r * shock / n;
            const GasState gas = blast(r, 1);
            mass += gas.density * shell;
            energy += (0.5 * gas.density * gas.velocity * gas.velocity + gas.pressure / (gamma - 1)) * shell;
        }
        EXPECT_NEAR(mass, 4.0 / 3 * std::numbers::pi * shock * shock * shock, 1e-5 * mass);
        EXPECT_NEAR(energy, 1, 1e-5);
    }
}

TEST(SedovTaylor, RefusesWhatItIsNotMadeFor) {
    EXPECT_THROW(SedovTaylor(1, 1, 2), std::invalid_argument);
    EXPECT_THROW(SedovTaylor(0, 1, 1.4), std::invalid_argument);
}

}  // namespace
}  // namespace talus::reference
