#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "domain/fields.hpp"
#include "tests/support/grain_scene.hpp"

/// Grains that attract each other, against closed forms.
namespace talus::test {
namespace {

using dem::Vector3;

constexpr double radius = 10, density = 2500;  // [m], [kg/m3]

const dem::GrainMaterial soft_rock{.name = "soft rock",
                                   .density = density,
                                   .youngs_modulus = 1e4,
                                   .poisson_ratio = 0.25,
                                   .restitution = 1,
                                   .friction = 0.5};

/// Every pair in double precision.
GrainSimulation attracted(const Communicator& comm, double time_step, int interval,
                          const std::vector<GrainState>& grains) {
    GrainSetup setup = grain_setup({soft_rock}, radius, time_step);
    setup.self_gravity = SelfGravity{{.direct = true}, interval};
    ParticleSet set = grain_set(comm, grains);
    GrainGravity::add_fields(set);
    return {comm, setup, std::move(set)};
}

double total_energy(const GrainTotals& totals) {
    return totals.kinetic_energy + totals.rotational_energy + totals.potential_energy;
}

struct Orbit {
    double energy_error = 0;    ///< greatest, over the energy
    double distance_error = 0;  ///< of one grain from its first place after a period, over the axis
    Vector3<> momentum, angular_momentum_change;
};

/// Two grains of different mass on an ellipse of eccentricity 0.3 that they start on at the far point, over
/// one period of `blocks` blocks.
Orbit orbit(int blocks, int interval) {
    const Communicator comm(MPI_COMM_SELF);
    GrainState first{{}, {}, {}, radius, density}, second{{}, {}, {}, 0.7 * radius, density};
    const double m1 = mass_of(first), m2 = mass_of(second), mu = gravity::newton_constant * (m1 + m2);
    const double axis = 5 * radius, eccentricity = 0.3;
    const double apart = axis * (1 + eccentricity),
                 speed = std::sqrt(mu / axis * (1 - eccentricity) / (1 + eccentricity)),
                 period = 2 * std::numbers::pi * std::sqrt(axis * axis * axis / mu);
    first.position.x = -m2 / (m1 + m2) * apart;
    first.velocity.y = -m2 / (m1 + m2) * speed;
    second.position.x = m1 / (m1 + m2) * apart;
    second.velocity.y = m1 / (m1 + m2) * speed;
    GrainSimulation run = attracted(comm, period / (blocks * interval), interval, {first, second});
    run.start();
    const GrainTotals before = run.totals();
    const double energy = -gravity::newton_constant * m1 * m2 / (2 * axis);
    EXPECT_NEAR(total_energy(before), energy, 1e-12 * std::abs(energy));
    Orbit found;
    for (int k = 0; k < blocks * interval; ++k) {
        run.step();
        if (run.is_synchronous())
            found.energy_error =
                std::max(found.energy_error, std::abs(total_energy(run.totals()) / energy - 1));
    }
    const GrainTotals after = run.totals();
    EXPECT_EQ(after.contacts, 0U);
    found.distance_error = norm(state_of(run, 1).position - second.position) / axis;
    const double size = m1 * norm(first.velocity), turning = m1 * m2 / (m1 + m2) * apart * speed;
    for (std::size_t a = 0; a < 3; ++a) {
        EXPECT_LT(std::abs(after.momentum[a] - before.momentum[a]), 1e-12 * size);
        EXPECT_LT(std::abs(after.angular_momentum[a] - before.angular_momentum[a]), 1e-12 * turning);
    }
    return found;
}

// Leapfrog with a block of T/200: the first is what the scheme does to an ellipse that is eccentric by 0.3,
// of second order in the block whether or not it is divided into steps.
TEST(GrainGravity, KeplersEllipseIsOfSecondOrderInTheBlock) {
    for (const int interval : {1, 8}) {
        const Orbit coarse = orbit(200, interval), fine = orbit(400, interval);
        EXPECT_LT(coarse.energy_error, 1e-3);
        EXPECT_LT(coarse.distance_error, 2e-2);
        EXPECT_NEAR(coarse.energy_error / fine.energy_error, 4, 0.2) << interval;
        EXPECT_NEAR(coarse.distance_error / fine.distance_error, 4, 0.2) << interval;
    }
    EXPECT_NEAR(orbit(200, 8).distance_error, orbit(200, 1).distance_error, 1e-9)
        << "between impulses grains fly straight";
}

// Let go two radii apart, they meet at the speed that the potential gives and bounce back to where they came
// from. The contact lasts 80 s, in which the second order of its own steps is what is lost.
TEST(GrainGravity, ElasticGrainsBounceBackToWhereTheyWere) {
    const Communicator comm(MPI_COMM_SELF);
    const GrainState left{{-2 * radius, 0, 0}, {}, {}, radius, density},
        right{{2 * radius, 0, 0}, {}, {}, radius, density};
    const double mass = mass_of(left);
    for (const int interval : {1, 5}) {
        GrainSimulation run = attracted(comm, 1, interval, {left, right});
        run.start();
        const double first = total_energy(run.totals());
        EXPECT_NEAR(first, -gravity::newton_constant * mass * mass / (4 * radius), 1e-12 * -first);
        double fastest = 0, farthest = 0;
        bool touched = false;
        for (int k = 0; k < 20000; ++k) {
            const double speed_before = state_of(run, 1).velocity.x;
            run.step();
            const GrainState now = state_of(run, 1);
            touched = touched || now.position.x < radius;
            if (!touched) fastest = std::max(fastest, -now.velocity.x);
            if (touched && now.position.x > radius) farthest = std::max(farthest, now.position.x);
            if (touched && speed_before > 0 && now.velocity.x < 0) break;
        }
        const double at_contact = std::sqrt(gravity::newton_constant * mass / (4 * radius));
        EXPECT_NEAR(fastest, at_contact, 0.01 * at_contact) << "interval " << interval;
        EXPECT_NEAR(farthest, 2 * radius, 2e-3 * radius) << "interval " << interval;
    }
}

// Overlapping spheres attract each other less than points, and those that press each other a little as
// points.
TEST(GrainGravity, SpheresThatTouchAttractAsPoints) {
    const Communicator comm(MPI_COMM_SELF);
    for (const double distance : {2.5, 2.0, 1.98, 1.0}) {
        const GrainState left{{}, {}, {}, radius, density},
            right{{distance * radius, 0, 0}, {}, {}, radius, density};
        GrainSimulation run = attracted(comm, 1, 1, {left, right});
        run.start();
        const double point =
            gravity::newton_constant * mass_of(left) / (distance * distance * radius * radius);
        const double found = run.grains().data(field::gravity_acceleration, 0)[0];
        if (distance > 1.5)
            EXPECT_NEAR(found, point, 1e-10 * point);
        else
            EXPECT_LT(found, 0.999 * point);
    }
}

/// Two dumbbells of unequal ends, across each other, on a close orbit in which they tumble.
GrainSimulation dumbbells(const Communicator& comm, double time_step, int interval) {
    GrainSetup setup = grain_setup({soft_rock}, radius, time_step);
    setup.self_gravity = SelfGravity{{.direct = true}, interval};
    const std::vector<Vector3<>> ends{{-radius, 0, 0}, {0.7 * radius, 0, 0}};
    const dem::ClumpShape shape = dem::clump_shape(ends, std::vector{radius, 0.7 * radius});
    setup.clumps = {{std::make_shared<const dem::ClumpShape>(shape), 0, density}};
    const double mass = setup.clumps[0].mass(), apart = 5 * radius,
                 speed = 0.55 * std::sqrt(gravity::newton_constant * mass / apart);
    const double s = std::sin(0.5), c = std::cos(0.5);
    return {comm, setup,
            clump_set(comm, setup,
                      {{{-apart / 2, 0, 0}, {0, -speed, 0}, {c, {0, 0, s}}, {}},
                       {{apart / 2, 0, 0}, {0, speed, 0}, {c, {0, 0.6 * s, -0.8 * s}}, {}}})};
}

// The attraction of two dumbbells is that of their spheres, each with its share of the mass: sums over four
// pairs of points, in closed form. What the spheres of one do to each other moves nothing.
TEST(GrainGravity, ClumpsAttractAsTheirSpheresAndTurnEachOther) {
    const Communicator comm(MPI_COMM_SELF);
    constexpr double step = 1;
    GrainSimulation run = dumbbells(comm, step, 1);
    run.start();
    const dem::ClumpBody body = run.setup().clumps[0];
    const dem::ClumpState first = clump_of(run, 0), second = clump_of(run, 2);
    Vector3<> force, torque;
    for (std::size_t k = 0; k < 2; ++k)
        for (std::size_t l = 0; l < 2; ++l) {
            const Vector3<> apart = state_of(run, 2 + l).position - state_of(run, k).position;
            const double masses =
                body.mass() * body.mass() * body.shape->mass_shares[k] * body.shape->mass_shares[l];
            const Vector3<> on_sphere =
                (gravity::newton_constant * masses / std::pow(norm(apart), 3)) * apart;
            force += on_sphere;
            torque += cross(state_of(run, k).position - first.centre, on_sphere);
        }
    ASSERT_GT(norm(torque), 0.05 * radius * norm(force));
    run.step();  // half of an impulse at the start, half at the end: within a step of the first
    const dem::ClumpState then = clump_of(run, 0), other = clump_of(run, 2);
    const double mass = body.mass();
    EXPECT_LT(norm((mass / step) * (then.velocity - first.velocity) - force), 1e-4 * norm(force));
    EXPECT_LT(norm((1 / step) * (then.angular_momentum - first.angular_momentum) - torque),
              1e-3 * norm(torque));
    EXPECT_LT(norm(mass * (other.velocity - second.velocity) + mass * (then.velocity - first.velocity)),
              1e-12 * norm(force) * step);
}

// Momentum and angular momentum stay to rounding; the energy, of which the orbit and the turning exchange a
// good part, to second order in the block of steps.
TEST(GrainGravity, TumblingDumbbellsKeepWhatIsConserved) {
    const Communicator comm(MPI_COMM_SELF);
    constexpr double duration = 4000;  // [s]; the orbit takes some 3000
    std::vector<double> errors;
    for (const int blocks : {400, 800}) {
        constexpr int interval = 2;
        GrainSimulation run = dumbbells(comm, duration / (blocks * interval), interval);
        run.start();
        const GrainTotals before = run.totals();
        double error = 0, most_rotation = 0;
        for (int k = 0; k < blocks * interval; ++k) {
            run.step();
            if (!run.is_synchronous()) continue;
            const GrainTotals now = run.totals();
            error = std::max(error, std::abs(total_energy(now) - total_energy(before)));
            most_rotation = std::max(most_rotation, now.rotational_energy);
        }
        const GrainTotals after = run.totals();
        EXPECT_EQ(run.evaluated_contacts(), 0U);
        EXPECT_GT(most_rotation, 0.01 * before.kinetic_energy);
        const double size = 0.5 * before.mass * before.greatest_speed;
        for (std::size_t a = 0; a < 3; ++a) {
            EXPECT_LT(std::abs(after.momentum[a]), 1e-12 * size);
            EXPECT_LT(std::abs(after.angular_momentum[a] - before.angular_momentum[a]),
                      1e-12 * size * 5 * radius);
        }
        errors.push_back(error / before.kinetic_energy);
    }
    EXPECT_LT(errors[1], 1e-3);
    EXPECT_NEAR(errors[0] / errors[1], 4, 0.5);
}

TEST(GrainGravity, AGrainThatIsNotFiniteStopsTheRun) {
    const Communicator comm(MPI_COMM_SELF);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    GrainSimulation run = attracted(
        comm, 1, 4, {{{}, {}, {}, radius, density}, {{100, 0, 0}, {0, nan, 0}, {}, radius, density}});
    try {
        run.start();
        for (int k = 0; k < 10; ++k) run.step();
        FAIL() << "no stop";
    } catch (const AgreedError& error) {
        EXPECT_NE(std::string(error.what()).find("of grain 1 is not finite"), std::string::npos)
            << error.what();
    }
}

}  // namespace
}  // namespace talus::test
