#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/support/exact_riemann.hpp"

namespace talus::reference {
namespace {

constexpr GasState sod_left{1, 0, 1}, sod_right{0.125, 0, 0.1};

// Toro 2009, table 4.3, test 1.
TEST(ExactRiemann, SodTubeHasThePublishedStarStates) {
    const ExactRiemann sod(sod_left, sod_right, 1.4);
    EXPECT_NEAR(sod.star_pressure(), 0.30313, 5e-6);
    EXPECT_NEAR(sod.star_velocity(), 0.92745, 5e-6);
    EXPECT_NEAR(sod.star_density_left(), 0.42632, 5e-6);
    EXPECT_NEAR(sod.star_density_right(), 0.26557, 5e-6);
    EXPECT_NEAR(sod.wave_speeds().right_head, 1.75216, 5e-6);
    EXPECT_EQ(sod.wave_speeds().right_head, sod.wave_speeds().right_tail);
}

// Toro 2009, table 4.3, tests 2 to 5.
TEST(ExactRiemann, ToroTubesHaveThePublishedStarStates) {
    struct Tube {
        GasState left, right;
        double p, v, rho_left, rho_right, tolerance;
    };
    const Tube tubes[] = {
        {{1, -2, 0.4}, {1, 2, 0.4}, 0.00189, 0, 0.02185, 0.02185, 5e-6},
        {{1, 0, 1000}, {1, 0, 0.01}, 460.894, 19.5975, 0.57506, 5.99924, 5e-6},
        {{1, 0, 0.01}, {1, 0, 100}, 46.0950, -6.19633, 5.99242, 0.57511, 5e-6},
        {{5.99924, 19.5975, 460.894}, {5.99242, -6.19633, 46.0950}, 1691.64, 8.68975, 14.2823, 31.0426, 5e-6},
    };
    for (const Tube& tube : tubes) {
        const ExactRiemann exact(tube.left, tube.right, 1.4);
        EXPECT_NEAR(exact.star_pressure(), tube.p, tube.tolerance * (1 + tube.p));
        EXPECT_NEAR(exact.star_velocity(), tube.v, tube.tolerance * (1 + std::abs(tube.v)));
        EXPECT_NEAR(exact.star_density_left(), tube.rho_left, tube.tolerance * (1 + tube.rho_left));
        EXPECT_NEAR(exact.star_density_right(), tube.rho_right, tube.tolerance * (1 + tube.rho_right));
    }
}

TEST(ExactRiemann, SamplesTheStatesBetweenTheWaves) {
    const ExactRiemann sod(sod_left, sod_right, 1.4);
    EXPECT_EQ(sod.sample(-1.2).density, 1);
    EXPECT_EQ(sod.sample(1.76).density, 0.125);
    EXPECT_EQ(sod.sample(0.5).density, sod.star_density_left());
    EXPECT_EQ(sod.sample(1.5).density, sod.star_density_right());
    // The fan is isentropic and joins its two ends.
    const WaveSpeeds waves = sod.wave_speeds();
    for (const double part : {0.0, 0.3, 0.7, 1.0}) {
        const GasState state = sod.sample(waves.left_head + part * (waves.left_tail - waves.left_head));
        EXPECT_NEAR(state.pressure, std::pow(state.density, 1.4), 1e-14);
        EXPECT_NEAR(state.velocity + 5 * std::sqrt(1.4 * state.pressure / state.density), 5 * std::sqrt(1.4),
                    1e-14);
    }
}

TEST(ExactRiemann, MirroredTubeGivesTheMirroredSolution) {
    const ExactRiemann tube(sod_left, sod_right, 5. / 3), mirror(sod_right, sod_left, 5. / 3);
    for (double speed = -2.03; speed < 2; speed += 0.05) {
        const GasState a = tube.sample(speed), b = mirror.sample(-speed);
        EXPECT_NEAR(a.density, b.density, 1e-14);
        EXPECT_NEAR(a.velocity, -b.velocity, 1e-14);
        EXPECT_NEAR(a.pressure, b.pressure, 1e-14);
    }
}

// The three Rankine-Hugoniot relations across a strong shock.
TEST(ExactRiemann, ShockConservesMassMomentumAndEnergy) {
    const double gamma = 1.4;
    const GasState right{1, 0, 0.01};
    const ExactRiemann tube({1, 0, 1000}, right, gamma);
    const double speed = tube.wave_speeds().right_head;
    const GasState star{tube.star_density_right(), tube.star_velocity(), tube.star_pressure()};
    const auto energy = [&](const GasState& s) {
        return s.pressure / (gamma - 1) + 0.5 * s.density * s.velocity * s.velocity;
    };
    EXPECT_NEAR(star.density * (speed - star.velocity) / (right.density * speed), 1, 1e-13);
    EXPECT_NEAR((star.pressure - right.pressure) / (right.density * speed * star.velocity), 1, 1e-13);
    const double gained = energy(star) * (speed - star.velocity) - energy(right) * speed;
    EXPECT_NEAR(star.pressure * star.velocity / gained, 1, 1e-12);
}

TEST(ExactRiemann, RefusesVacuum) {
    EXPECT_THROW(ExactRiemann({1, -10, 1}, {1, 10, 1}, 1.4), std::invalid_argument);
    EXPECT_THROW(ExactRiemann({1, 0, -1}, {1, 0, 1}, 1.4), std::invalid_argument);
}

}  // namespace
}  // namespace talus::reference
