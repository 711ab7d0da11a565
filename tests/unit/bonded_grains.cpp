#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "domain/grain_fields.hpp"
#include "tests/support/grain_scene.hpp"

/// Bonds through the whole step. A beam of 40 mm, 1 mm in radius, E = 1 GPa, nu = 0.3, 1000 kg/m3: a row of
/// grains whose first is held. What one bond does is tested in dem_bonds.cpp.
namespace talus::test {
namespace {

using dem::Vector3;
constexpr double pi = std::numbers::pi;
constexpr double length = 0.04, section_radius = 1e-3, density = 1000, E = 1e9, G = E / 2.6;
const double area = pi * section_radius * section_radius,
             second_moment = area * section_radius * section_radius / 4;
const dem::BondMaterial plastic{.youngs_modulus = E, .poisson_ratio = 0.3};
const dem::GrainMaterial soft{
    .name = "soft", .density = density, .youngs_modulus = 1e7, .poisson_ratio = 0.3};

struct Beam {
    int bonds;
    GrainSetup setup;
    std::vector<GrainState> grains;

    double spacing() const { return length / bonds; }
    double mass() const { return density * area * spacing(); }

    /// Along x from the held grain 0; the tip has half the mass, as the end of a beam that is cut into pieces
    /// around its nodes.
    explicit Beam(int bond_count, const Vector3<>& gravity = {})
        : bonds(bond_count), setup(grain_setup({soft, soft}, 0.5 * spacing(), 1)) {
        const double r = spacing() / 2;
        const dem::BeamBond bond(plastic, section_radius, spacing());
        const double m = 0.5 * mass();
        setup.time_step = 0.3 * bond.stable_step(m, 0.4 * m * r * r, 2);
        setup.held = {0, 1};
        setup.gravity = gravity;
        for (const std::uint8_t other : {0, 1})
            setup.bonds.push_back({{0, other}, 0.01, section_radius / r, plastic});
        const double full = mass() / (4.0 / 3 * pi * r * r * r);
        for (int k = 0; k <= bonds; ++k)
            grains.push_back({{k * spacing(), 0, 0},
                              {},
                              {},
                              r,
                              k == bonds ? 0.5 * full : full,
                              static_cast<std::uint8_t>(k == 0 ? 1 : 0)});
    }
    GrainSimulation started(const Communicator& comm) const {
        GrainSimulation run(comm, setup, grain_set(comm, grains));
        run.start();
        EXPECT_EQ(run.totals().bonds, static_cast<std::uint64_t>(bonds));
        EXPECT_LE(setup.time_step, run.stable_step_of_bonds());
        return run;
    }
    GrainState tip(const GrainSimulation& run) const {
        return state_of(run, static_cast<std::uint64_t>(bonds));
    }
};

// Load of all nodes: P_i (a^2 (3 L - a)/(6 EI) + a/(kappa G A)) each at its distance a; beam elements are
// exact in their nodes. Let go under its weight a beam without damping swings about where it would rest: the
// mean over some periods, weighted by 1 - cos so that no part of a period counts, within (deflection/L)^2 of
// the geometry = 1e-5.
TEST(BondedGrains, CantileverBendsUnderItsWeightAsTimoshenkoSays) {
    const Communicator comm(MPI_COMM_SELF);
    const double g = 80, kappa = 6 * 1.3 / 8.8;
    const Beam beam(10, {0, 0, -g});
    double bent = 0;
    for (int k = 1; k <= beam.bonds; ++k) {
        const double a = k * beam.spacing(), m = beam.mass() * (k == beam.bonds ? 0.5 : 1);
        bent += m * g * (a * a * (3 * length - a) / (6 * E * second_moment) + a / (kappa * G * area));
    }
    GrainSimulation run = beam.started(comm);
    const double period = 1 / 174.87;
    const int steps = static_cast<int>(8 * period / run.time_step());
    double mean = 0;
    for (int k = 1; k < steps; ++k) {
        run.step();
        mean += (1 - std::cos(2 * pi * k / steps)) / steps * beam.tip(run).position.z;
    }
    EXPECT_NEAR(-mean / bent, 1, 3e-4);
    EXPECT_EQ(run.totals().contacts, 0U) << "bonded grains must not touch";
}

/// Period from the zeros of a value, two periods from the first zero on.
double period_of(GrainSimulation& run, const std::function<double()>& value) {
    std::vector<double> zeros;
    for (double before = value(); zeros.size() < 5;) {
        run.step();
        const double now = value();
        if (before * now < 0) zeros.push_back(run.time() - run.time_step() * now / (now - before));
        before = now;
    }
    return (zeros[4] - zeros[0]) / 2;
}

/// 2 pi over the frequency that leapfrog gives to omega.
double leapfrog_period(double omega, double time_step) {
    return pi * time_step / std::asin(omega * time_step / 2);
}

// A row of n springs k and masses m, one end fixed, the other of half the mass: 2 sqrt(k/m) sin(pi/(4n)) with
// sin(pi i/(2n)) at place i. Bonds are such springs for stretching and for twisting; 1e-5 is left to the
// zeros and to what twisted balls swing sideways.
TEST(BondedGrains, StretchingAndTwistingSwingAsARowOfSprings) {
    const Communicator comm(MPI_COMM_SELF);
    for (const bool twisting : {false, true}) {
        Beam beam(10);
        const double r = beam.spacing() / 2;
        for (int k = 1; k <= beam.bonds; ++k) {
            const double share = std::sin(pi * k / (2 * beam.bonds));
            (twisting ? beam.grains[static_cast<std::size_t>(k)].angular_velocity.x
                      : beam.grains[static_cast<std::size_t>(k)].velocity.x) = (twisting ? 1 : 0.001) * share;
        }
        const double stiffness = twisting ? 2 * G * second_moment : E * area;
        const double inertia = twisting ? 0.4 * beam.mass() * r * r : beam.mass();
        const double omega =
            2 * std::sqrt(stiffness / beam.spacing() / inertia) * std::sin(pi / (4 * beam.bonds));
        GrainSimulation run = beam.started(comm);
        const double period = period_of(run, [&] {
            const GrainState tip = beam.tip(run);
            return twisting ? tip.angular_velocity.x : tip.velocity.x;
        });
        EXPECT_NEAR(period / leapfrog_period(omega, run.time_step()), 1, 1e-5) << twisting;
    }
}

// (1.8751^2/2 pi) sqrt(EI/(rho A L^4)) = 174.87 Hz; lumped masses and their rotation cost some 1/n^2.
TEST(BondedGrains, CantileverSwingsAtItsFirstFrequency) {
    const Communicator comm(MPI_COMM_SELF);
    double errors[2];
    for (int refinement = 0; refinement < 2; ++refinement) {
        Beam beam(8 << refinement);
        const double k = 1.87510407 / length, sigma = 0.73409551;
        for (GrainState& grain : beam.grains) {
            const double kx = k * grain.position.x;
            grain.velocity.z = 0.01 * (std::cosh(kx) - std::cos(kx) - sigma * (std::sinh(kx) - std::sin(kx)));
            grain.angular_velocity.y =
                -0.01 * k * (std::sinh(kx) + std::sin(kx) - sigma * (std::cosh(kx) - std::cos(kx)));
        }
        GrainSimulation run = beam.started(comm);
        const double period = period_of(run, [&] { return beam.tip(run).position.z; });
        errors[refinement] = 1 / period / 174.87 - 1;
        EXPECT_LT(std::abs(errors[refinement]), refinement == 0 ? 0.015 : 0.004);
    }
    EXPECT_LT(std::abs(errors[1]), std::abs(errors[0]));
}

// A cube of 27 grains: bonds of their edges. What turns with it strains only as its inertia does: a few times
// m omega^2 d over the stiffness of a bond to shear, 12 EI/d^3 with a third off for Timoshenko's beam; angles
// are that over d. After a quarter of a turn.
TEST(BondedGrains, RigidRotationStrainsNoBond) {
    const Communicator comm(MPI_COMM_SELF);
    const Beam beam(10);
    GrainSetup setup = beam.setup;
    const Vector3<> spin{60, 0, 80};
    std::vector<GrainState> cube;
    const double d = beam.spacing();
    for (int k = 0; k < 27; ++k) {
        GrainState grain{
            {d * (k % 3 - 1), d * (k / 3 % 3 - 1), d * (k / 9 - 1)}, {}, spin, d / 2, beam.grains[1].density};
        grain.velocity = cross(spin, grain.position);
        cube.push_back(grain);
    }
    setup.time_step *= 0.5;  // up to six bonds, not two
    GrainSimulation run(comm, setup, grain_set(comm, cube));
    run.start();
    EXPECT_EQ(run.totals().bonds, 54U);
    ASSERT_LE(setup.time_step, run.stable_step_of_bonds());
    const double before = run.totals().kinetic_energy + run.totals().rotational_energy;
    while (run.time() < 0.5 * pi / 100) run.step();
    const double after = run.totals().kinetic_energy + run.totals().rotational_energy;
    EXPECT_NEAR(after / before, 1, 1e-3);
    run.save();
    const ParticleSet bonds = run.saved_bonds();
    const double strained = 3 * beam.mass() * dot(spin, spin) * d / (8 * E * second_moment / (d * d * d));
    double shear = 0, angle = 0;
    for (std::size_t k = 0; k < bonds.size(); ++k) {
        for (int axis = 0; axis < 3; ++axis) {
            shear = std::max(shear, std::abs(bonds.data(field::shearing, axis)[k]));
            angle = std::max(angle, std::abs(bonds.data(field::bending, axis)[k]));
        }
        angle = std::max(angle, std::abs(bonds.data(field::twisting)[k]));
    }
    EXPECT_LT(shear, strained);
    EXPECT_LT(angle, strained / d);
}

/// Two grains that touch, bonded.
GrainSimulation pair_of(const Communicator& comm, const dem::BondMaterial& material,
                        const Vector3<>& velocity, const Vector3<>& spin) {
    const double r = 2e-3;
    const GrainState one{{-r, 0, 0}, velocity, spin, r, density};
    GrainState other = one;
    other.position = -one.position;
    other.velocity = -one.velocity;
    other.angular_velocity = -one.angular_velocity;
    GrainSetup setup = grain_setup({soft}, r, 1e-7);
    setup.bonds.push_back({{0, 0}, 0.01, 0.5, material});
    GrainSimulation run(comm, setup, grain_set(comm, {one, other}));
    run.start();
    return run;
}

TEST(BondedGrains, ABrokenBondLeavesAContact) {
    // Pressed together and twisted against each other until the bond breaks: then they push each other apart
    // as Hertz says, with the energy of their overlap.
    const Communicator comm(MPI_COMM_SELF);
    dem::BondMaterial weak = plastic;
    weak.youngs_modulus = 1e8;
    weak.shear_strength = 2e4;
    GrainSimulation run = pair_of(comm, weak, {0.3, 0, 0}, {50, 0, 0});
    EXPECT_EQ(run.totals().bonds, 1U);
    while (run.totals().bonds > 0 && run.step_count() < 10000) {
        EXPECT_EQ(run.totals().contacts, 0U);
        run.step();
    }
    ASSERT_EQ(run.totals().broken_bonds, 1U);
    EXPECT_EQ(run.grains().data(field::broken_bonds)[0], 1U);
    const double overlap = 4e-3 + state_of(run, 0).position.x - state_of(run, 1).position.x;
    EXPECT_GT(overlap, 1e-7);
    run.step();
    EXPECT_EQ(run.totals().contacts, 1U);
    const double m = mass_of({{}, {}, {}, 2e-3, density}), modulus = 1e7 / (2 * 0.91);
    const double stored = 8.0 / 15 * modulus * std::sqrt(1e-3) * std::pow(overlap, 2.5);
    const double v = state_of(run, 0).velocity.x;
    while (run.totals().contacts > 0 && run.step_count() < 100000) run.step();
    EXPECT_NEAR(state_of(run, 0).velocity.x, -std::sqrt(v * v + stored / m), 0.01 * std::abs(v));
}

TEST(BondedGrains, PulledApartItBreaksAtItsStrengthOrStopsTheRun) {
    const Communicator comm(MPI_COMM_SELF);
    dem::BondMaterial material = plastic;
    material.tensile_strength = 2e6;  // at a strain of 0.002
    GrainSimulation run = pair_of(comm, material, {-1, 0, 0}, {});
    double length_before = 0;
    while (run.totals().bonds > 0 && run.step_count() < 10000) {
        length_before = state_of(run, 1).position.x - state_of(run, 0).position.x;
        run.step();
    }
    EXPECT_NEAR(length_before / 4e-3 - 1, 0.002, 0.0002);  // a step stretches by 5e-5
    EXPECT_EQ(run.totals().broken_bonds, 1U);

    GrainSimulation endless = pair_of(comm, plastic, {-300, 0, 0}, {});
    try {
        for (int k = 0; k < 1000; ++k) endless.step();
        FAIL() << "a bond was stretched without end";
    } catch (const AgreedError& error) {
        EXPECT_NE(std::string(error.what()).find("the bond between grains 0 and 1 is longer than 1.1 of its"),
                  std::string::npos)
            << error.what();
    }
}

}  // namespace
TEST(BondedGrains, OneThatIsNotFiniteStopsTheRun) {
    const Communicator comm(MPI_COMM_SELF);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    try {
        GrainSimulation run = pair_of(comm, plastic, {}, {0, 0, nan});
        for (int k = 0; k < 3; ++k) run.step();
        FAIL() << "no stop";
    } catch (const AgreedError& error) {
        const std::string what = error.what();
        EXPECT_TRUE(what.find("angular_velocity of grain 1 is not finite") != std::string::npos ||
                    what.find("the bond between grains 0 and 1 bears a force that is not finite") !=
                        std::string::npos)
            << what;
    }
}

}  // namespace talus::test
