#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "physics/dem/bonds/beam_bond.hpp"
#include "tests/support/grain_collision.hpp"

// A beam of 40 mm, 1 mm in radius, E = 1 GPa, nu = 0.3, 1000 kg/m3: a chain of balls joined by bonds.

namespace talus::dem {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double length = 0.04, radius = 1e-3, density = 1000;
const BondMaterial plastic{.youngs_modulus = 1e9, .poisson_ratio = 0.3};
const double area = pi * radius * radius, second_moment = area * radius * radius / 4;

struct Chain {
    std::vector<Ball> balls;
    std::vector<Vector3<>> forces, torques, external, external_torques;
    std::vector<BeamBond> bonds;
    std::vector<BeamBond::History> histories;
    std::vector<BondResponse> responses;
    bool clamped = true;

    /// Along x; the masses are those of the beam, half at its ends.
    explicit Chain(int bond_count, const BondMaterial& material = plastic) {
        const double spacing = length / bond_count;
        for (int k = 0; k <= bond_count; ++k) {
            Ball ball;
            ball.radius = spacing / 2;
            ball.mass = density * area * spacing * (k == 0 || k == bond_count ? 0.5 : 1);
            ball.position = {k * spacing, 0, 0};
            balls.push_back(ball);
        }
        bonds.assign(static_cast<std::size_t>(bond_count), BeamBond(material, radius, spacing));
        histories.assign(bonds.size(), {});
        responses.assign(bonds.size(), {});
        forces.assign(balls.size(), {});
        torques = external = external_torques = forces;
    }
    double stable_step() const { return bonds[0].stable_step(balls[0].mass, balls[0].inertia(), 2); }

    void kick(double dt, double drag) {
        for (std::size_t k = clamped ? 1 : 0; k < balls.size(); ++k) {
            Ball& b = balls[k];
            b.kick(forces[k], torques[k], dt / 2);
            b.velocity = (1 - drag * dt / 2) * b.velocity;
            b.angular_velocity = (1 - drag * dt / 2) * b.angular_velocity;
        }
    }
    void step(double dt, double drag = 0) {
        kick(dt, drag);
        for (Ball& b : balls) b.drift(dt);
        forces = external;
        torques = external_torques;
        for (std::size_t k = 0; k < bonds.size(); ++k) {
            const Ball &a = balls[k], &b = balls[k + 1];
            const auto kinematics =
                bond_kinematics(a.position - b.position, a, a.inertia(), b, b.inertia(), dt);
            responses[k] = bonds[k](kinematics, histories[k]);
            const ContactLoad<double>& load = responses[k].load;
            forces[k] += load.force;
            forces[k + 1] += -load.force;
            const double arm = kinematics.length / 2;
            torques[k] += torque_about_centre(kinematics.normal, arm, load);
            torques[k + 1] +=
                torque_about_centre<double>(-kinematics.normal, arm, {-load.force, -load.couple});
        }
        kick(dt, drag);
    }
    /// Until it rests under what pulls it.
    void settle() {
        const double dt = 0.5 * stable_step();
        for (double time = 0; time < 0.04; time += dt) step(dt, 1200);
    }
};

TEST(BeamBonds, CantileverBendsAsTimoshenkoSays) {
    // P L^3/(3 EI) + P L/(kappa G A): 0.27199 mm, 0.27162 mm without shear. Beam elements are exact in the
    // nodes; what is left is of second order in the deflection, (0.27/40)^2.
    const double P = 0.01, G = 1e9 / 2.6, kappa = 6 * 1.3 / 8.8;
    for (const bool shear_compliance : {true, false}) {
        BondMaterial material = plastic;
        material.shear_compliance = shear_compliance;
        Chain chain(10, material);
        chain.external.back() = {0, 0, -P};
        chain.settle();
        const double euler = P * length * length * length / (3e9 * second_moment);
        EXPECT_NEAR(euler, 0.27162e-3, 1e-8);
        const double expected = euler + (shear_compliance ? P * length / (kappa * G * area) : 0);
        EXPECT_NEAR(-chain.balls.back().position.z / expected, 1, 1e-4);
        EXPECT_LT(norm(chain.balls.back().velocity), 1e-7);
        // At the root: bending moment P L, tension of its outermost fibre.
        EXPECT_NEAR(chain.responses[0].tensile_stress / (P * length * radius / second_moment), 1, 1e-3);
    }
}

TEST(BeamBonds, PulledAndTwistedBars) {
    Chain pulled(8);
    pulled.external.back() = {20, 0, 0};
    pulled.settle();
    EXPECT_NEAR((pulled.balls.back().position.x - length) / (20 * length / (1e9 * area)), 1, 1e-6);
    EXPECT_NEAR(pulled.responses[3].tensile_stress / (20 / area), 1, 1e-6);

    Chain twisted(8);
    const double T = 1e-3;
    twisted.external_torques.back() = {T, 0, 0};
    twisted.settle();
    EXPECT_NEAR(twisted.responses[3].shear_stress / (T * radius / (2 * second_moment)), 1, 1e-3);
    double twist = 0;
    for (const BeamBond::History& history : twisted.histories) twist += std::abs(history[6]);
    EXPECT_NEAR(twist / (T * length / (1e9 / 2.6 * 2 * second_moment)), 1, 1e-3);
}

TEST(BeamBonds, CantileverSwingsAtItsFirstFrequency) {
    // (1.8751^2/2 pi) sqrt(EI/(rho A L^4)) = 174.87 Hz. Lumped masses and their rotation cost some 1/n^2.
    const double expected = 1.87510407 * 1.87510407 / (2 * pi) *
                            std::sqrt(1e9 * second_moment / (density * area * std::pow(length, 4)));
    EXPECT_NEAR(expected, 174.87, 0.01);
    double errors[2];
    for (int refinement = 0; refinement < 2; ++refinement) {
        Chain chain(8 << refinement);
        const double k = 1.87510407 / length, sigma = 0.73409551;
        for (std::size_t n = 1; n < chain.balls.size(); ++n) {  // set going in its first mode
            Ball& b = chain.balls[n];
            const double kx = k * b.position.x;
            b.velocity.z = 0.01 * (std::cosh(kx) - std::cos(kx) - sigma * (std::sinh(kx) - std::sin(kx)));
            b.angular_velocity.y =
                -0.01 * k * (std::sinh(kx) + std::sin(kx) - sigma * (std::cosh(kx) - std::cos(kx)));
        }
        const double dt = 0.5 * chain.stable_step();
        std::vector<double> crossings;
        double before = 0;
        for (int step = 1; crossings.size() < 4; ++step) {
            chain.step(dt);
            const double z = chain.balls.back().position.z;
            if (before * z < 0) crossings.push_back((step - z / (z - before)) * dt);
            before = z;
        }
        errors[refinement] =
            2 / crossings[3] / expected - 1;  // from zero to the fourth crossing: two periods
        EXPECT_LT(std::abs(errors[refinement]), refinement == 0 ? 0.015 : 0.004);
    }
    EXPECT_LT(std::abs(errors[1]), std::abs(errors[0]));
}

TEST(BeamBonds, RigidRotationCarriesNoTorque) {
    // About axes across it and along it (its principal axes: about others it is truly bent), ten turns.
    // Bounds: what a bond bears that is deformed by 1e-6 rad.
    for (const Vector3<>& axis : {Vector3<>{0, 0, 1}, Vector3<>{1, 0, 0}, Vector3<>{0, 0.6, 0.8}}) {
        Chain chain(4);
        chain.clamped = false;
        const Vector3<> spin = 100.0 * axis, middle{length / 2, 0, 0};
        for (Ball& b : chain.balls) {
            b.velocity = cross(spin, b.position - middle);
            b.angular_velocity = spin;
        }
        const double dt = 0.5 * chain.stable_step();
        double energy = 0, greatest_couple = 0, greatest_shear = 0;
        for (const Ball& b : chain.balls) energy += b.kinetic_energy();
        for (double time = 0; time < 10 * 2 * pi / 100; time += dt) {
            chain.step(dt);
            for (const BondResponse& r : chain.responses) {
                greatest_couple = std::max(greatest_couple, norm(r.load.couple));
                greatest_shear = std::max(greatest_shear, r.shear_stress);
            }
        }
        double energy_after = 0;
        for (const Ball& b : chain.balls) energy_after += b.kinetic_energy();
        EXPECT_LT(greatest_couple, 1e-6 * 1e9 * second_moment / 0.01);
        EXPECT_LT(greatest_shear, 1e-6 * 1e9);
        EXPECT_NEAR(energy_after / energy, 1, 1e-3);
    }
}

TEST(BeamBonds, SecondSideSeesTheNegativeToTheBit) {
    const BeamBond bond({.youngs_modulus = 1e9, .poisson_ratio = 0.3, .damping_ratio = 0.1}, 1e-3, 4e-3);
    const Grain<double> a{{0.1, 0.3, -0.2}, {30, -10, 25}, 2e-3, 1e-5},
        b{{-0.2, 0.1, 0.05}, {-3, 20, 11}, 3e-3, 3e-5};
    BeamBond::History history{}, reversed{};
    Vector3<> separation{3.1e-3, -1.2e-3, 2.2e-3};
    for (int step = 0; step < 20; ++step) {
        const auto one = bond(bond_kinematics(separation, a, 1e-11, b, 4e-11, 1e-6), history);
        const auto other = bond(bond_kinematics(-separation, b, 4e-11, a, 1e-11, 1e-6), reversed);
        EXPECT_EQ(one.load.force, -other.load.force);
        EXPECT_EQ(one.load.couple, -other.load.couple);
        EXPECT_EQ(one.shear_stress, other.shear_stress);
        EXPECT_EQ(one.tensile_stress, other.tensile_stress);
        separation += Vector3<>{1e-7, 3e-7, -2e-7};
    }
}

TEST(BeamBonds, BreakAtTheirStrength) {
    // Pulled slowly: at sigma A; bent by a force at its end: at sigma I/(r L).
    BondMaterial material = plastic;
    material.tensile_strength = 2e6;
    const double axial = 2e6 * area, bending = 2e6 * second_moment / (radius * length);
    for (const auto& [direction, strength] :
         {std::pair{Vector3<>{1, 0, 0}, axial}, {Vector3<>{0, 1, 0}, bending}})
        for (const double share : {0.99, 1.01}) {
            Chain chain(5, material);
            chain.external.back() = (share * strength) * direction;
            chain.settle();
            EXPECT_EQ(chain.bonds[0].breaks(chain.responses[0]), share > 1);
        }
    material.tensile_strength = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(BeamBond(material, radius, 0.01).breaks({{}, 1e30, 1e30}));
    material.shear_strength = 1e6;
    EXPECT_TRUE(BeamBond(material, radius, 0.01).breaks({{}, 0, 1.01e6}));
}

}  // namespace
}  // namespace talus::dem
