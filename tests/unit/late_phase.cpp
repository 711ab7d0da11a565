#include "physics/solid/late_phase.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "tests/support/solid_materials.hpp"

namespace talus {
namespace {

Material rock() {
    return {.name = "basalt",
            .eos = test::basalt(),
            .shear_modulus = 22.7e9,
            .bulk_modulus = 26.7e9,
            .reference_density = 2700,
            .fracture = Fracture{.weibull_k = 4e35, .weibull_m = 9}};
}

TEST(LatePhase, SlowsSoundByTheRootOfTheStiffnessAndCracksNotAtAll) {
    const Material stiff = rock(), soft = softened(stiff, 0.01);
    EXPECT_NEAR(soft.longitudinal_speed(), 0.1 * stiff.longitudinal_speed(), 1e-9);
    EXPECT_NEAR(evaluate(soft.eos, 2700, 0).sound_speed, 0.1 * evaluate(stiff.eos, 2700, 0).sound_speed,
                1e-9);
    EXPECT_EQ(bulk_modulus(soft.eos), soft.bulk_modulus);
    EXPECT_NEAR(soft.crack_growth().crack_speed, stiff.crack_growth().crack_speed, 1e-9);
    EXPECT_NEAR(soft.crack_growth().young_modulus / stiff.crack_growth().young_modulus, 1, 1e-14);
    const Material twice = softened(soft, 0.5);
    EXPECT_NEAR(twice.crack_growth().crack_speed, stiff.crack_growth().crack_speed, 1e-9);
}

/// Pressures at depth in a body of 50 km (some MPa), of a slow impact (some 100 MPa), warm matter, tension
/// within what the softer rock holds, none at all. The roots are found by halving an interval 60 times: to
/// rounding.
TEST(LatePhase, KeepsThePressure) {
    const Material stiff = rock(), soft = softened(stiff, 0.01);
    const std::vector<double> energy = {0, 1e3, 0, 2e4, 0, 0};
    std::vector<double> density = {
        2700 * (1 + 1e-4), 2700 * (1 + 2e-4), 2700 * (1 + 1e-2), 2710, 2700 * (1 - 5e-4), 2700};
    const std::vector<std::uint8_t> body(density.size(), 0);
    const std::vector<double> before = density;
    keep_pressure(stiff.eos, soft.eos, energy, density, body, 0);
    for (std::size_t i = 0; i < density.size(); ++i)
        EXPECT_NEAR(pressure(soft.eos, density[i], energy[i]), pressure(stiff.eos, before[i], energy[i]), 1)
            << i;
    EXPECT_NEAR(density[0] / 2700 - 1, 0.0099, 0.0002)
        << "P = A mu + B mu^2: a hundred times the compression";
    EXPECT_NEAR(density[5], 2700, 1e-9);
}

/// P = 0.01 (A mu + B mu^2) with mu = 3 is the most that four times the density gives.
TEST(LatePhase, TellsWhatLosesPressure) {
    const Material stiff = rock(), soft = softened(stiff, 0.01);
    std::vector<double> density = {2710, 2700 * 2.5, 2700 * 1.5, 2700 * 2.5};
    const double most = pressure(soft.eos, most_compressed * 2700, 0);
    const std::vector<std::size_t> expected = {1, 3};
    ASSERT_GT(pressure(stiff.eos, density[1], 0), most);
    ASSERT_LT(pressure(stiff.eos, density[0], 0), most);
    density[2] = 2700 * 1.001;
    EXPECT_EQ(keep_pressure(stiff.eos, soft.eos, std::vector<double>(4, 0.0), density,
                            std::vector<std::uint8_t>(4, 0), 0),
              expected);
    EXPECT_NEAR(density[1], most_compressed * 2700, 1e-6);
}

/// Rock warmed by friction is wider than cold rock where it is free of pressure, by as much when it is
/// softer: else it would swell at the change.
TEST(LatePhase, ExpandsWarmRockNoMore) {
    const Material stiff = rock(), soft = softened(stiff, 0.01);
    const double warm = 2e4;
    std::vector<double> density = {2680};
    const double before = pressure(stiff.eos, density[0], warm);
    ASSERT_LT(before, -1e6) << "a crack that is open";
    keep_pressure(stiff.eos, soft.eos, std::vector<double>{warm}, density, std::vector<std::uint8_t>{0}, 0);
    EXPECT_LT(pressure(soft.eos, density[0], warm), 0);
    for (const double rho : {2600.0, 2680.0, 2750.0})
        EXPECT_NEAR(pressure(soft.eos, rho, warm), 0.01 * pressure(stiff.eos, rho, warm),
                    1e-6 * std::abs(before));
}

TEST(LatePhase, LeavesTornMatterAndOtherBodiesAlone) {
    const Material stiff = rock(), soft = softened(stiff, 0.01);
    std::vector<double> density = {2200, 2720};
    keep_pressure(stiff.eos, soft.eos, std::vector<double>{0, 0}, density, std::vector<std::uint8_t>{0, 1},
                  0);
    EXPECT_EQ(density[0], 2200) << "stretched further than the softer rock could hold";
    EXPECT_EQ(density[1], 2720);
}

TEST(LatePhase, KnowsNoIdealGas) {
    Material gas = rock();
    gas.eos = IdealGas{};
    EXPECT_THROW(softened(gas, 0.1), std::invalid_argument);
}

}  // namespace
}  // namespace talus
