#include <gtest/gtest.h>

#include <cmath>

#include "physics/soil/constitutive.hpp"
#include "physics/soil/time_factor.hpp"

namespace talus::soil {
namespace {

Material clay(YieldSurface surface, double reference) {
    return {.name = "clay",
            .density = 2000,
            .elasticity = {.youngs_modulus = 8e7, .poisson_ratio = 0.3},
            .overstress = {.fluidity = 2, .exponent = 1, .reference = reference},
            .surface = surface};
}

/// Relaxes for a time in steps as long as a run takes them.
void relax_for(const Material& material, double seconds, Tensor& stress, History& history) {
    constexpr int steps = 200;
    for (int k = 0; k < steps; ++k) ASSERT_TRUE(relax(material, 1, seconds / steps, stress, history));
}

TEST(SoilElasticity, StressAndEnergyAreThoseOfHookesLaw) {
    const Elasticity elasticity{.youngs_modulus = 8e7, .poisson_ratio = 0.3};
    const Tensor strain{1e-3, -2e-3, 5e-4, 3e-4, -1e-4, 2e-4};
    const Tensor stress = elasticity.stress_of(strain);
    EXPECT_NEAR(stress[0] - 0.3 * (stress[1] + stress[2]), 8e7 * strain[0], 1e-6);
    EXPECT_NEAR(stress[3], 2 * elasticity.shear_modulus() * strain[3], 1e-9);
    EXPECT_NEAR(elasticity.energy(stress), 0.5 * contraction(stress, strain), 1e-9);
    EXPECT_NEAR(elasticity.wave_modulus(), 8e7 * 0.7 / (1.3 * 0.4), 1e-6);
}

TEST(SoilVonMises, PureShearRelaxesExponentiallyToTheYieldSurface) {
    // q = sqrt(3) tau, and dq/dt = -3 G gamma (q - Y)/Y: (q - Y) falls as exp(-3 G gamma t / Y).
    const Material material = clay(VonMises{.yield_stress = 1e5}, 1e5);
    Tensor stress{0, 0, 0, 1.5e5, 0, 0};
    History history;
    const double rate = 3 * material.elasticity.shear_modulus() * 2 / 1e5, time = 1.5 / rate;
    const double before = mises_stress(stress);
    relax_for(material, time, stress, history);
    EXPECT_NEAR(mises_stress(stress) - 1e5, (before - 1e5) * std::exp(-1.5), 1e-6 * before);
    EXPECT_NEAR(history.strain, (before - mises_stress(stress)) / (3 * material.elasticity.shear_modulus()),
                1e-9 * history.strain);
    relax_for(material, 40 / rate, stress, history);
    EXPECT_NEAR(mises_stress(stress), 1e5, 1e-3);
    EXPECT_EQ(trace(stress), 0);
}

TEST(SoilVonMises, SofteningEndsAtTheResidualStrength) {
    const Material material = clay(VonMises{.yield_stress = 1e5, .hardening = -8e6, .residual = 4e4}, 1e5);
    Tensor stress{0, 0, 0, 1.5e5, 0, 0};
    History history{.strain = 1};  // far beyond softening
    relax_for(material, 0.05, stress, history);
    EXPECT_NEAR(mises_stress(stress), 4e4, 1);
}

TEST(SoilVonMises, UniaxialBarRelaxesWithItsYoungsModulus) {
    // Closed form: s - Y falls as exp(-E gamma t / Y).
    Material bar = clay(VonMises{.yield_stress = 1e5}, 1e5);
    bar.elasticity.uniaxial_stress = true;
    Tensor stress{-3e5, 0, 0, 0, 0, 0};
    History history;
    const double time = 1 / (8e7 * 2 / 1e5);
    relax_for(bar, time, stress, history);
    EXPECT_NEAR(stress[0], -1e5 - 2e5 * std::exp(-1.0), 1);
    EXPECT_EQ(stress[1], 0);
}

TEST(SoilDruckerPrager, TriaxialStrengthIsThatOfMohrAndCoulombOnTheEdgesItFits) {
    const double friction = 0.5, cohesion = 1e4, sine = std::sin(friction), cosine = std::cos(friction);
    for (const bool outer : {true, false}) {
        // Outer: compression, s1 - s3 = 2 (c cos + p sin) with p the mean of the two; inner: extension.
        const double confinement = -5e4;
        const double other = -((1 + sine) / (1 - sine) * -confinement + 2 * cohesion * cosine / (1 - sine));
        const DruckerPrager surface{.cohesion = cohesion,
                                    .friction = std::tan(friction),
                                    .match = outer ? ConeMatch::compression : ConeMatch::extension};
        const Tensor stress = outer ? Tensor{other, confinement, confinement, 0, 0, 0}
                                    : Tensor{confinement, other, other, 0, 0, 0};
        EXPECT_NEAR(surface.at(stress, {}, 1).excess, 0, 1e-6 * std::abs(other));
    }
}

TEST(SoilDruckerPrager, ReturnsToTheConeAndFromBeyondItsApex) {
    const DruckerPrager surface{.cohesion = 1e4, .friction = 0.6, .dilation = 0.1};
    const Material material = clay(surface, 1e4);
    for (Tensor stress : {Tensor{-1e5, -2e5, -4e5, 5e4, 0, 1e4}, Tensor{9e4, 9e4, 9e4, 0, 0, 0},
                          Tensor{6e4, 5e4, 9e4, 1e3, 0, 0}}) {
        History history;
        relax_for(material, 2, stress, history);
        EXPECT_NEAR(surface.at(stress, history, 1).excess, 0, 1) << stress[0];
    }
}

TEST(SoilDruckerPrager, BearsNoTensionBeyondItsApexWithoutDilation) {
    // At the apex the mean stress is c / tan(phi); each step's pull relaxes within it (rate 9 K alpha^2
    // fluidity / c: 15 a step).
    const double friction = std::tan(M_PI / 6);
    Material material = clay(DruckerPrager{.cohesion = 1e3, .friction = friction}, 1e3);
    material.overstress.fluidity = 10;
    Tensor stress{};
    History history;
    for (int step = 0; step < 1000; ++step) {  // confined in two directions, pulled at 0.01/s
        const Tensor added = material.elasticity.stress_of({1e-2 * 1e-3, 0, 0, 0, 0, 0});
        for (std::size_t k = 0; k < 6; ++k) stress[k] += added[k];
        ASSERT_TRUE(relax(material, 1, 1e-3, stress, history));
    }
    EXPECT_NEAR(trace(stress) / 3, 1e3 / friction, 1);
    EXPECT_LT(mises_stress(stress), 1);
}

TEST(SoilConstitutive, AHighExponentFarBeyondTheSurfaceTakesShorterSteps) {
    // q - Y = x: dx/dt = -3 G gamma (x / Y)^N, x^(1-N) = x0^(1-N) + (N - 1) 3 G gamma t / Y^N.
    Material material = clay(VonMises{.yield_stress = 1e3}, 1e3);
    material.overstress.exponent = 5;
    material.overstress.fluidity = 1e-6;
    Tensor stress{0, 0, 0, 2.1e4 / std::sqrt(3.0), 0, 0};
    History history;
    ASSERT_TRUE(relax(material, 1, 1e-3, stress, history));
    const double rate = 3 * material.elasticity.shear_modulus() * 1e-6 / 1e3;
    const double left = std::pow(std::pow(20.0, -4) + 4 * rate * 1e-3, -0.25);
    EXPECT_NEAR(mises_stress(stress) / 1e3 - 1, left, 1e-3 * left);
}

TEST(SoilConstitutive, FastRelaxationEndsOnTheSurfaceOrIsRefused) {
    Material material = clay(VonMises{.yield_stress = 1e3}, 1e3);
    Tensor stress{0, 0, 0, 1e4, 0, 0};
    History history;
    material.overstress.fluidity = 1e9;
    EXPECT_TRUE(relax(material, 1, 1e-3, stress, history));
    EXPECT_NEAR(mises_stress(stress), 1e3, 1e-3);
    stress[3] = 1e4;
    material.overstress.fluidity = 1e308;
    EXPECT_FALSE(relax(material, 1, 1e-3, stress, history));
    EXPECT_EQ(stress[3], 1e4);
}

TEST(SoilCamClay, ConsolidationMovesTheSurfaceByTheVolumetricStrain) {
    const CamClay surface{
        .slope = 1.2, .compression = 0.2, .swelling = 0.04, .void_ratio = 1, .preconsolidation = 1e5};
    const Material material = clay(surface, 1e5);
    Tensor stress{-1.4e5, -1.4e5, -1.4e5, 0, 0, 0};
    History history{.preconsolidation = 1e5};
    relax_for(material, 5, stress, history);
    const double p = -trace(stress) / 3;
    EXPECT_NEAR(p, history.preconsolidation, 10);
    // d p_c / p_c = (1 + e)/(lambda - kappa) d e_v with K d e_v = -dp.
    const double strain = (1.4e5 - p) / material.elasticity.bulk_modulus();
    EXPECT_NEAR(std::log(history.preconsolidation / 1e5), 2 / 0.16 * strain, 1e-4);
    EXPECT_NEAR(history.strain, 0, 1e-12);
}

TEST(SoilConstitutive, TurnedAxesTurnTheResult) {
    // Objectivity: exchanging axes of the stress exchanges those of the relaxed stress.
    const Material material = clay(DruckerPrager{.cohesion = 1e4, .friction = 0.6, .dilation = 0.1}, 1e4);
    Tensor stress{-1e5, -2e5, -4e5, 5e4, 3e4, 1e4}, turned{-2e5, -4e5, -1e5, 1e4, 5e4, 3e4};
    History a, b;
    relax_for(material, 0.001, stress, a);
    relax_for(material, 0.001, turned, b);
    const std::array<std::size_t, 6> place{2, 0, 1, 4, 5, 3};  // of xx yy zz xy xz yz in the turned one
    for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(stress[k], turned[place[k]], 1e-7 * 4e5);
    EXPECT_NEAR(a.strain, b.strain, 1e-12);
}

TEST(SoilTimeFactor, FollowsItsPoints) {
    const TimeFactor ramp{.times = {1, 3}, .values = {0, 4}};
    EXPECT_EQ(ramp(0), 0);
    EXPECT_EQ(ramp(2), 2);
    EXPECT_EQ(ramp(9), 4);
    EXPECT_EQ(TimeFactor{}(5), 1);
    EXPECT_NEAR((TimeFactor{.frequency = 2})(0.25), -1, 1e-12);
}

}  // namespace
}  // namespace talus::soil
