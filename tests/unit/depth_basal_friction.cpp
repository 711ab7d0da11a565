#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "physics/depth/basal_friction.hpp"

namespace talus::depth {
namespace {

constexpr Column column{
    .depth = 2, .density = 1800, .normal_stress = 3e4, .pore_pressure = 1e4, .gravity = 9.81};
constexpr std::array speeds{1e-9, 1e-4, 0.03, 0.8, 5.0, 40.0, 700.0};
constexpr std::array time_steps{1e-8, 1e-3, 0.1, 5.0, 1e4, 1e12};

const std::vector<BasalFriction> laws{Frictionless{},
                                      Coulomb{.friction = 0.4, .cohesion = 500},
                                      Voellmy{.friction = 0.2, .turbulence = 1500},
                                      Manning{.roughness = 0.033},
                                      Chezy{.coefficient = 40},
                                      Newtonian{.viscosity = 120},
                                      Bingham(4790, 958),
                                      HerschelBulkley(800, 300, 0.4),
                                      HerschelBulkley(800, 300, 1.7),
                                      HerschelBulkley(0, 300, 0.5),
                                      PerzynaViscoplastic(1000, 0.3, 2, 5000, 1),
                                      PerzynaViscoplastic(0, 0.3, 0.5, 5000, 2.5)};

template <class Check>
void for_each_law(Check&& check) {
    for (std::size_t k = 0; k < laws.size(); ++k) {
        SCOPED_TRACE(k);
        std::visit(check, laws[k]);
    }
}

/// Shear rate of a profile summed over the depth by the midpoint rule: the mean of the speed over the depth.
template <class ShearRate>
double mean_speed_by_sum(ShearRate&& shear_rate, double depth) {
    constexpr int count = 200000;
    double sum = 0;
    for (int k = 0; k < count; ++k) {
        const double height = (k + 0.5) / count;
        sum += (1 - height) * shear_rate(height);  // the speed's integral by parts
    }
    return depth * sum / count;
}

TEST(BasalFriction, StressesAsTheirFormulasSay) {
    EXPECT_DOUBLE_EQ((Coulomb{0.4, 500}.stress(3, column)), 500 + 2e4 * 0.4);
    EXPECT_DOUBLE_EQ((Voellmy{0.2, 1500}.stress(3, column)), 4000 + 1800 * 9.81 * 9 / 1500);
    EXPECT_DOUBLE_EQ((Manning{0.033}.stress(3, column)), 1800 * 9.81 * 0.033 * 0.033 * 9 / std::cbrt(2.0));
    EXPECT_DOUBLE_EQ((Chezy{40}.stress(3, column)), 1800 * 9.81 * 9 / 1600);
    EXPECT_DOUBLE_EQ((Newtonian{120}.stress(3, column)), 3 * 120 * 3 / 2.0);
}

/// eta^3 - (3 + a) eta + 2 = 0, eta = tau_y / tau, a = 6 mu s / (h tau_y). Tolerance: rounding, amplified by
/// the slope of the cubic, which vanishes as s^(1/2) towards rest.
TEST(BasalFriction, BinghamSolvesItsCubic) {
    const Bingham law(4790, 958);
    for (const double speed : speeds) {
        const double eta = 4790 / law.stress(speed, column), a = 6 * 958 * speed / (2 * 4790.0);
        EXPECT_NEAR(eta * eta * eta - (3 + a) * eta + 2, 0, 1e-14 * (3 + a)) << speed;
        EXPECT_GT(eta, 0);
        EXPECT_LT(eta, 1);
    }
}

TEST(BasalFriction, LawsReduceToSimplerOnes) {
    for (const double speed : speeds) {
        const auto expect_same = [&](const auto& law, const auto& simpler) {
            EXPECT_NEAR(law.stress(speed, column) / simpler.stress(speed, column), 1, 1e-13) << speed;
            for (const double time_step : time_steps)
                EXPECT_NEAR(law.speed_after(speed, time_step, column),
                            simpler.speed_after(speed, time_step, column), 1e-13 * speed)
                    << speed << ' ' << time_step;
        };
        expect_same(Bingham(0, 120), Newtonian{120});
        expect_same(HerschelBulkley(4790, 958, 1), Bingham(4790, 958));
        expect_same(PerzynaViscoplastic(4790, 0, 2, 2 * 958, 1), Bingham(4790, 958));
        expect_same(PerzynaViscoplastic(0, 0, 2, 240, 1), Newtonian{120});
        expect_same(PerzynaViscoplastic(0, 0, 1, 1000, 2), HerschelBulkley(0, 1000, 0.5));
    }
    // As viscosity vanishes, friction is left.
    EXPECT_NEAR(PerzynaViscoplastic(0, 0.3, 1e12, 1, 1).stress(10, column), 0.3 * 2e4, 1e-6);
}

/// Profiles summed over the depth at the stress that the law gives. Tolerance: (1 / number of layers)^2 for
/// smooth profiles; the rate has a kink (n = 1.7: an infinite slope) at the plug.
TEST(BasalFriction, SpeedIsTheMeanOfTheProfile) {
    for (const double speed : {0.03, 0.8, 5.0}) {
        for (const double exponent : {0.4, 1.0, 1.7}) {
            const double stress = HerschelBulkley(800, 300, exponent).stress(speed, column);
            const double mean = mean_speed_by_sum(
                [&](double height) {
                    const double over = stress * (1 - height) - 800;
                    return over > 0 ? std::pow(over / 300, 1 / exponent) : 0;
                },
                2);
            EXPECT_NEAR(mean / speed, 1, exponent > 1 ? 1e-6 : 1e-8);
        }
        const double stress = PerzynaViscoplastic(1000, 0.3, 2, 5000, 2).stress(speed, column);
        const double mean = mean_speed_by_sum(
            [&](double height) {
                const double strength = 1000 + 0.3 * (3e4 - 1e4) * (1 - height);
                const double over = stress * (1 - height) - strength;
                return over > 0 ? 2 * std::pow(over / 5000, 2) : 0;
            },
            2);
        EXPECT_NEAR(mean / speed, 1, 1e-8);
    }
}

TEST(BasalFriction, StressGrowsWithSpeed) {
    for_each_law([](const auto& law) {
        double before = law.stress(0, column);
        EXPECT_GE(before, 0);
        for (const double speed : speeds) {
            const double stress = law.stress(speed, column);
            EXPECT_GE(stress, before) << speed;
            before = stress;
        }
    });
}

/// Implicit Euler: s' = s - dt stress(s') / (rho h), or rest if the stress at rest suffices. Tolerance:
/// rounding of the speed before.
TEST(BasalFriction, StepIsImplicitForAnyTimeStep) {
    for_each_law([](const auto& law) {
        for (const double speed : speeds)
            for (const double time_step : time_steps) {
                const double after = law.speed_after(speed, time_step, column);
                const double stop = time_step * law.stress(0, column) / column.mass();
                EXPECT_GE(after, 0);
                EXPECT_LE(after, speed);
                if (speed <= stop * (1 - 1e-15)) {
                    EXPECT_EQ(after, 0) << speed << ' ' << time_step;
                }
                if (after > 0) {
                    EXPECT_NEAR((after + time_step * law.stress(after, column) / column.mass()) / speed, 1,
                                1e-12)
                        << speed << ' ' << time_step;
                }
            }
    });
}

TEST(BasalFriction, SpeedAfterGrowsWithSpeedBefore) {
    for_each_law([](const auto& law) {
        for (const double time_step : time_steps) {
            double before = 0;
            for (double speed = 1e-6; speed < 100; speed *= 1.3) {
                const double after = law.speed_after(speed, time_step, column);
                EXPECT_GE(after, before) << speed << ' ' << time_step;
                before = after;
            }
        }
    });
}

/// A flow with a law that holds at rest ends at exactly zero after a time that its deceleration bounds.
TEST(BasalFriction, FlowsWithStrengthStop) {
    for (const BasalFriction& law :
         {BasalFriction(Coulomb{0.4, 500}), BasalFriction(Voellmy{0.2, 1500}),
          BasalFriction(Bingham(4790, 958)), BasalFriction(HerschelBulkley(800, 300, 0.4)),
          BasalFriction(PerzynaViscoplastic(1000, 0.3, 2, 5000, 1))})
        std::visit(
            [](const auto& chosen) {
                const double least_deceleration = chosen.stress(0, column) / column.mass();
                double speed = 20, time = 0;
                while (speed > 0 && time < 1000) {
                    speed = chosen.speed_after(speed, 0.01, column);
                    time += 0.01;
                }
                EXPECT_EQ(speed, 0);
                EXPECT_LE(time, 20 / least_deceleration + 0.02);
            },
            law);
}

TEST(BasalFriction, ColumnsWithoutDepthDoNotRun) {
    const Column empty{.depth = 0, .density = 1800, .normal_stress = 0};
    for_each_law([&](const auto& law) {
        const double after = law.speed_after(3, 0.1, empty);
        EXPECT_TRUE(after >= 0 && after <= 3) << after;
    });
}

TEST(BasalFriction, PorePressureTakesFriction) {
    Column liquefied = column;
    liquefied.pore_pressure = 4e4;  // beyond the normal stress: no tension
    EXPECT_EQ((Coulomb{0.4}.stress(1, liquefied)), 0);
    EXPECT_EQ((Coulomb{0.4}.speed_after(1, 10, liquefied)), 1);
}

}  // namespace
}  // namespace talus::depth
