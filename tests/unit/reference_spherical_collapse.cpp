#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/spherical_collapse.hpp"

/// The reference of runs/evrard against itself and what is known of it.
namespace talus::reference {
namespace {

TEST(SphericalCollapse, KeepsItsEnergyAndConverges) {
    SphericalCollapse coarse(100), middle(200), fine(400);
    EXPECT_NEAR(fine.energies().total(), 0.05 - 2.0 / 3, 1e-5);
    for (const double time : {0.4, 0.8, 1.2, 2.0}) {
        for (SphericalCollapse* ball : {&coarse, &middle, &fine}) ball->run_to(time);
        const BallEnergies a = coarse.energies(), b = middle.energies(), c = fine.energies();
        EXPECT_NEAR(c.total(), 0.05 - 2.0 / 3, 0.005);
        if (time == 0.4) continue;  // all alike within 1e-3
        EXPECT_LT(std::abs(c.thermal - b.thermal), 0.75 * std::abs(b.thermal - a.thermal));
        EXPECT_LT(std::abs(c.potential - b.potential), 0.75 * std::abs(b.potential - a.potential));
        EXPECT_NEAR(c.potential, b.potential, 0.02 * std::abs(c.potential));
    }
}

TEST(SphericalCollapse, FallsFreelyBeforeTheShock) {
    SphericalCollapse ball(400);
    ball.run_to(0.1);
    // Every shell falls with the same G M/R^2, but the outermost, from which pressure pushes off.
    EXPECT_NEAR(ball.energies().kinetic, 0.5 * 0.1 * 0.1, 0.1 * 0.005);
}

}  // namespace
}  // namespace talus::reference
