#include "physics/solid/plasticity.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "physics/solid/stress_update.hpp"

/// The return of stress to the yield surface at a single point, against closed forms.
namespace talus::test {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr Elasticity sand{.bulk_modulus = 20e6, .shear_modulus = 12e6, .reference_density = 2000};

DruckerPrager soil(ConeMatch match, double cohesion, double friction_angle, double dilation_angle) {
    DruckerPrager model;
    model.peak = model.residual = cone(match, cohesion, friction_angle, dilation_angle);
    model.tensile_strength = std::numeric_limits<double>::infinity();
    return model;
}

/// A piece of soil in plane strain, led along a path of velocity gradients.
struct Point {
    Plasticity model;
    double density = sand.reference_density, pressure = 0;
    std::array<double, 3> stress{};  // deviator, xx yy xy
    double volume_strain = 0, shear_strain = 0;

    void squeeze(double p) { density = sand.reference_density * (1 + p / sand.bulk_modulus); }

    void step(const std::array<double, 4>& gradient, double time) {
        density *= std::exp(-(gradient[0] + gradient[3]) * time);
        stress = advanced_stress<2>(stress, gradient, sand.shear_modulus, time);
        const std::uint8_t body = 0;
        const bool opens = std::visit([](const auto& m) { return m.keeps_volume_strain(); }, model);
        const bool softens = std::visit([](const auto& m) { return m.softens(); }, model);
        PlasticState state{{&density, 1}, {2, {&stress[0], &stress[1], &stress[2]}}, {}, {}};
        if (opens) state.volume_strain = {&volume_strain, 1};
        if (softens) state.shear_strain = {&shear_strain, 1};
        return_stress(model, sand, state, time, true, {&pressure, 1}, {&body, 1}, 0);
    }
    double shear() const {
        return std::sqrt(stress[0] * stress[0] + stress[1] * stress[1] + stress[0] * stress[1] +
                         stress[2] * stress[2]);
    }
    /// (sigma_1 - sigma_3)/2 and (sigma_1 + sigma_3)/2 in the plane, compression positive.
    double radius() const { return std::hypot(0.5 * (stress[0] - stress[1]), stress[2]); }
    double centre() const { return pressure - 0.5 * (stress[0] + stress[1]); }
};

constexpr std::array<double, 4> simple_shear{0, 1, 0, 0};

TEST(Cone, TouchesTheEdgesOfMohrAndCoulomb) {
    const double c = 3e3, phi = 35 * degree, lateral = 50e3;
    const double k = (1 + std::sin(phi)) / (1 - std::sin(phi));
    // sigma_1 = k sigma_3 + 2 c sqrt(k); the middle stress equals the least in compression, the greatest in
    // extension.
    const double greatest = k * lateral + 2 * c * std::sqrt(k);
    const Cone outer = cone(ConeMatch::compression, c, phi, 0), inner = cone(ConeMatch::extension, c, phi, 0);
    const double size = (greatest - lateral) / std::sqrt(3.0);
    EXPECT_NEAR(size, outer.cohesion + outer.friction * (greatest + 2 * lateral) / 3, 1e-12 * size);
    EXPECT_NEAR(size, inner.cohesion + inner.friction * (2 * greatest + lateral) / 3, 1e-12 * size);
    const Cone associated = cone(ConeMatch::plane_strain, c, phi, phi);  // Drucker & Prager 1952
    const double root = std::sqrt(9 + 12 * std::tan(phi) * std::tan(phi));
    EXPECT_NEAR(associated.friction, 3 * std::tan(phi) / root, 1e-14);
    EXPECT_NEAR(associated.cohesion, 3 * c / root, 1e-10);
    EXPECT_NEAR(associated.dilation, associated.friction, 1e-14);
}

TEST(Return, SimpleShearAtConstantVolumeIsFollowedInAnyNumberOfSteps) {
    // tau = G gamma up to the cone; then dilation would raise the volume, so p grows: dp = (K + p) d dl, dtau
    // = f dp = G (dgamma - dl), which gives G ln((K + p)/(K + p0)) + f d (p - p0) = d G (gamma - yield).
    const double phi = 30 * degree, psi = 10 * degree, p0 = 100e3, gamma = 0.012;
    const DruckerPrager model = soil(ConeMatch::plane_strain, 1e3, phi, psi);
    const double G = sand.shear_modulus, K = sand.bulk_modulus;
    const Cone& c = model.peak;
    const double yield = (c.cohesion + c.friction * p0) / G;
    double p = p0;
    double high = 10 * p0;
    for (int k = 0; k < 60; ++k) {  // bisection
        const double middle = 0.5 * (p + high);
        const double left = G * std::log((K + middle) / (K + p0)) + c.friction * c.dilation * (middle - p0);
        (left < c.dilation * G * (gamma - yield) ? p : high) = middle;
    }
    for (const auto& [steps, tolerance] : {std::pair{1, 2e-3}, {10, 1e-3}, {100, 1e-4}}) {
        // Without rotation the direction of flow is constant: e_xy alone.
        Point point{.model = model};
        point.squeeze(p0);
        for (int k = 0; k < steps; ++k) point.step({0, 0.5, 0.5, 0}, gamma / steps);
        EXPECT_NEAR(point.pressure, p, tolerance * p) << steps << " steps";
        EXPECT_NEAR(point.stress[2], c.cohesion + c.friction * point.pressure, 1e-9 * p);
    }
}

TEST(Return, PlaneStrainFlowsAtCoulombsRatioAndDilationAngle) {
    for (const double psi : {0.0, 12 * degree, 32 * degree}) {
        const double cohesion = 2e3, phi = 32 * degree;
        Point point{.model = soil(ConeMatch::plane_strain, cohesion, phi, psi)};
        point.squeeze(200e3);
        // Biaxial compression along y, widening along x so that p stays where it is once the soil flows.
        const double widening = (1 + std::sin(psi)) / (1 - std::sin(psi));
        for (int k = 0; k < 20000; ++k) point.step({widening * 1e-5, 0, 0, -1e-5}, 1);
        EXPECT_NEAR(point.radius(), cohesion * std::cos(phi) + point.centre() * std::sin(phi),
                    1e-6 * point.centre())
            << "psi = " << psi;
        const double before = point.pressure;
        for (int k = 0; k < 100; ++k) point.step({widening * 1e-5, 0, 0, -1e-5}, 1);
        EXPECT_NEAR(point.pressure, before, 1e-5 * before) << "flow is at the dilation angle";
    }
}

TEST(Return, ApexAndTensionCutOff) {
    DruckerPrager model = soil(ConeMatch::compression, 5e3, 30 * degree, 0);
    const double apex = model.peak.cohesion / model.peak.friction;
    EXPECT_NEAR(apex, 5e3 / std::tan(30 * degree), 1e-9);
    Returned end = returned(model, sand, {-2 * apex, 4e3}, 0);
    EXPECT_EQ(end.state.shear, 0);
    EXPECT_NEAR(end.state.pressure, -apex, 1e-9);
    EXPECT_EQ(end.volume_strain, 0);
    EXPECT_NEAR((sand.bulk_modulus - 2 * apex) * std::exp(end.gap), sand.bulk_modulus - apex, 1e-6);
    model.tensile_strength = 0;
    end = returned(model, sand, {-0.5 * apex, 4e3}, 0);
    EXPECT_EQ(end.state.pressure, 0);
    EXPECT_NEAR(end.state.shear, std::min(4e3, model.peak.cohesion), 1e-9);
    // Strong dilation leads over the apex: the cone ends there.
    DruckerPrager dilating = soil(ConeMatch::compression, 5e3, 30 * degree, 30 * degree);
    end = returned(dilating, sand, {-3 * apex, 1e3}, 0);
    EXPECT_EQ(end.state.shear, 0);
    EXPECT_NEAR(end.state.pressure, -apex, 1e-9);
    EXPECT_GT(end.volume_strain, 0);
}

TEST(Return, ElasticStatesAreLeftAlone) {
    const DruckerPrager model = soil(ConeMatch::compression, 0, 30 * degree, 10 * degree);
    const Returned end = returned(model, sand, {1e5, 0.9 * model.peak.friction * 1e5}, 0);
    EXPECT_EQ(end.state.pressure, 1e5);
    EXPECT_EQ(end.state.shear, 0.9 * model.peak.friction * 1e5);
    EXPECT_EQ(end.volume_strain, 0);
}

/// Rate form of H. H. Bui et al. (2008), eqs 20-24, without spin, in explicit steps: what the return must
/// tend to.
struct RateForm {
    Cone cone;
    std::array<double, 3> s{};
    double p;

    void step(const std::array<double, 3>& e,
              double time) {  // deviatoric strain rate xx yy xy, no volume change
        const double G = sand.shear_modulus, K = sand.bulk_modulus + p;  // per volume strain
        const double tau = std::sqrt(s[0] * s[0] + s[1] * s[1] + s[0] * s[1] + s[2] * s[2]);
        const double power = 2 * (s[0] * e[0] + s[1] * e[1] + s[2] * e[2]) + s[0] * e[1] + s[1] * e[0];
        double lambda = 0;
        if (tau >= (cone.cohesion + cone.friction * p) * (1 - 1e-12))
            lambda = std::max(0.0, G / tau * power / (G + K * cone.friction * cone.dilation));
        for (std::size_t c = 0; c < 3; ++c)
            s[c] += time * (2 * G * e[c] - lambda * G / std::max(tau, 1e-300) * s[c]);
        p += time * K * cone.dilation * lambda;
    }
};

TEST(Return, TendsToTheRateFormAtFirstOrder) {
    // Shear whose direction turns by 90 degrees in the plane while the soil flows.
    const DruckerPrager model = soil(ConeMatch::plane_strain, 1e3, 30 * degree, 10 * degree);
    const double p0 = 100e3, rate = 0.05;
    const auto strain = [&](double t) {
        const double angle = 0.5 * std::numbers::pi * t;
        return std::array<double, 3>{rate * std::cos(angle), -rate * std::cos(angle), rate * std::sin(angle)};
    };
    RateForm exact{.cone = model.peak, .p = p0};
    constexpr int fine = 400000;
    for (int k = 0; k < fine; ++k) exact.step(strain((k + 0.5) / fine), 1.0 / fine);
    std::vector<double> errors;
    for (const int steps : {25, 50, 100}) {
        Point point{.model = model};
        point.squeeze(p0);
        for (int k = 0; k < steps; ++k) {
            const auto e = strain((k + 0.5) / steps);
            point.step({e[0], e[2], e[2], e[1]}, 1.0 / steps);
        }
        errors.push_back(std::hypot(point.stress[0] - exact.s[0], point.stress[2] - exact.s[2]) /
                         point.shear());
    }
    EXPECT_LT(errors[2], 0.01);
    EXPECT_GT(errors[0] / errors[1], 1.7);
    EXPECT_GT(errors[1] / errors[2], 1.7);
}

TEST(LargeShear, JaumannsRateIsBoundedByTheStrength) {
    // Without strength sigma_xy = G sin(gamma), and the normal stresses swing by as much. With it the spin
    // brings shear into them at a rate tau and flow takes it out at G/tau: s_xx = -s_yy = tau^2/G, a share
    // tau/G of the strength.
    const double p0 = 100e3, phi = 30 * degree;
    Point point{.model = soil(ConeMatch::plane_strain, 0, phi, 0)};
    point.squeeze(p0);
    const double strength = std::sin(phi) * p0;
    for (int k = 0; k < 80000; ++k) {
        point.step(simple_shear, 1e-4);
        if (k > 1000) {
            ASSERT_NEAR(point.stress[2], strength, 1e-4 * strength) << "gamma = " << 1e-4 * k;
        }
    }
    const double swing = point.stress[0] - point.stress[1];
    const double expected = 2 * strength * strength / sand.shear_modulus;
    EXPECT_NEAR(swing, expected, 0.02 * expected);
    EXPECT_NEAR(point.pressure, p0, 1e-6 * p0);
}

TEST(Softening, LeadsFromThePeakToTheResidual) {
    DruckerPrager model = soil(ConeMatch::plane_strain, 10e3, 0, 0);
    model.residual = cone(ConeMatch::plane_strain, 4e3, 0, 0);
    model.softening_strain = 0.1;
    Point point{.model = model};
    for (int k = 0; k < 300; ++k) point.step({0, 0.5, 0.5, 0}, 1e-3);
    EXPECT_NEAR(point.stress[2], 4e3, 1e-6);
    EXPECT_NEAR(point.shear_strain, 0.3, 0.001);
}

TEST(GranularFlow, ShearsAtItsLaw) {
    const GranularFlow law{.friction_static = 0.38,
                           .friction_limit = 0.64,
                           .inertial_number = 0.28,
                           .grain_diameter = 1e-3,
                           .grain_density = 2500};
    const double p0 = 2e3;
    for (const double rate : {0.0, 1.0, 50.0, 1e4}) {
        Point point{.model = law};
        point.squeeze(p0);
        const double time = rate > 0 ? 1e-4 / rate : 1e-4;  // first to the yield surface
        for (int k = 0; k < 2000; ++k)
            point.step({0, std::max(0.5 * rate, 0.0), std::max(0.5 * rate, 0.0), 0}, time);
        const double I = rate * law.grain_diameter * std::sqrt(law.grain_density / p0);
        const double mu = rate > 0 ? law.friction_static + (law.friction_limit - law.friction_static) * I /
                                                               (I + law.inertial_number)
                                   : 0;
        EXPECT_NEAR(point.stress[2] / p0, mu, 1e-9) << "rate " << rate;
    }
    EXPECT_EQ(returned(law, sand, {-1, 5}, 1e-3).state.shear, 0) << "stretched, it bears nothing";
}

}  // namespace
}  // namespace talus::test
