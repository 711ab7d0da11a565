#include <gtest/gtest.h>

#include <numbers>

#include "src/setup/impact.hpp"
#include "src/simulation.hpp"

namespace talus::test {
namespace {

using std::numbers::pi;

double degrees(double angle) { return angle * pi / 180; }

double distance_of(const RelativeState& state) { return norm(state.position); }

/// Follows two attracting points (mu = 0: free) until their distance is `end` on the way in.
RelativeState follow(RelativeState state, double mu, double end) {
    const auto rates = [mu](const RelativeState& s) {
        const double r = norm(s.position);
        return RelativeState{s.velocity, times(-mu / (r * r * r), s.position)};
    };
    const auto ahead = [](const RelativeState& s, double t, const RelativeState& rate) {
        return RelativeState{plus(s.position, times(t, rate.position)),
                             plus(s.velocity, times(t, rate.velocity))};
    };
    double step = 1e-3 * distance_of(state) / norm(state.velocity);
    for (int k = 0; k < 1000000 && std::abs(distance_of(state) - end) > 1e-11 * end; ++k) {
        const RelativeState k1 = rates(state), k2 = rates(ahead(state, step / 2, k1)),
                            k3 = rates(ahead(state, step / 2, k2)), k4 = rates(ahead(state, step, k3));
        RelativeState next = ahead(state, step / 6, k1);
        next = ahead(next, step / 3, k2);
        next = ahead(next, step / 3, k3);
        next = ahead(next, step / 6, k4);
        if (distance_of(next) < end)
            step /= 2;
        else
            state = next;
    }
    return state;
}

// Reference: the equations of motion, integrated with the Runge-Kutta method of fourth order with 1000 steps
// of the time to cross the first distance and more.
TEST(ImpactStart, LeadsToTheContactAskedFor) {
    const double mu = 2e8, touch = 1e4;  // escape speed 200 m/s
    for (const double gravity : {0.0, mu})
        for (const double speed : {150.0, 200.0, 500.0})
            for (const double angle : {0.0, 5.0, 30.0, 45.0, 80.0, 90.0}) {
                if (gravity > 0 && speed < 200 && angle > 0) continue;  // bound; see below
                const Contact contact{touch, degrees(angle), speed};
                const auto start = state_before(contact, 1.9 * touch, gravity);
                ASSERT_TRUE(start) << speed << " m/s at " << angle;
                EXPECT_NEAR(distance_of(*start), 1.9 * touch, 1e-9 * touch);
                if (angle == 90) continue;  // grazes: the distance has its minimum there
                const RelativeState end = follow(*start, gravity, touch);
                EXPECT_NEAR(end.velocity[0], -speed, 1e-7 * speed) << speed << " m/s at " << angle;
                EXPECT_NEAR(end.velocity[1], 0, 1e-7 * speed) << speed << " m/s at " << angle;
                EXPECT_NEAR(end.position[0], touch * std::cos(degrees(angle)), 1e-7 * touch);
                EXPECT_NEAR(end.position[1], touch * std::sin(degrees(angle)), 1e-7 * touch);
            }
}

// A bound pair was never farther apart than its greatest distance: head-on at v, 1/(1/r - v^2/2mu).
TEST(ImpactStart, OfABoundPairHasALimit) {
    const double mu = 2e8, touch = 1e4, speed = 150;
    const double farthest = 1 / (1 / touch - speed * speed / (2 * mu));
    EXPECT_TRUE(state_before({touch, 0, speed}, 0.9999 * farthest, mu));
    EXPECT_FALSE(state_before({touch, 0, speed}, 1.0001 * farthest, mu));
    EXPECT_TRUE(state_before({touch, 0, speed}, 100 * farthest, 0));
}

Body ball(double radius, double density, double spacing) {
    Body body;
    body.shape = SphereShape{{}, radius};
    body.cell = lattice_cell(Lattice::close_packed, 3);
    body.spacing = spacing;
    body.density = density;
    return body;
}

struct Placed {
    std::vector<Body> bodies;
    std::vector<BodyCensus> census;
    Impact impact;
};
Placed placed(const ImpactPlan& plan) {
    Placed result{{ball(50e3, 2700, 6e3), ball(30e3, 2000, 6e3)}, {}, {}};
    result.census = take_census(result.bodies, 3, 1);
    const PlannedImpact planned = plan_impact(plan, result.bodies, result.census, 3);
    EXPECT_TRUE(planned.impact) << planned.key << ": " << planned.fault;
    result.impact = planned.impact.value_or(Impact{});
    place(result.impact, result.bodies, result.census);
    return result;
}

TEST(Impacts, AngleAndOffsetSayTheSame) {
    const Placed by_angle = placed({.speed = 300, .angle = degrees(30), .gap = 0}),
                 by_offset = placed({.speed = 300, .offset = 40e3, .gap = 0});
    EXPECT_NEAR(by_angle.impact.impact_parameter, 40e3, 1e-9 * 40e3);
    EXPECT_NEAR(by_offset.impact.contact.angle, degrees(30), 1e-12);
    const Point apart = minus(centre(by_offset.bodies[1].shape), centre(by_offset.bodies[0].shape));
    EXPECT_NEAR(apart[0], 80e3 * std::cos(degrees(30)), 1e-6);
    EXPECT_NEAR(apart[1], 40e3, 1e-6);
    for (const Placed& each : {by_angle, by_offset}) {
        const Point v = minus(each.bodies[1].velocity, each.bodies[0].velocity);
        EXPECT_NEAR(v[0], -300, 1e-10);
        EXPECT_NEAR(v[1], 0, 1e-10);
        // Angle between the way of the impactor and the line from it to the target.
        EXPECT_NEAR(std::acos(-dot(v, apart) / norm(v) / norm(apart)), degrees(30), 1e-9);
    }
}

TEST(Impacts, HaveNoMomentumInTheFrameOfTheCentreOfMass) {
    const Placed found = placed({.speed = 300, .angle = degrees(20), .distance = 300e3, .along_orbit = true});
    Point momentum{}, moment{};
    for (std::size_t b = 0; b < 2; ++b) {
        momentum = plus(momentum, times(found.census[b].mass, found.bodies[b].velocity));
        moment = plus(moment, times(found.census[b].mass, found.census[b].centre_of_mass));
    }
    EXPECT_LT(norm(momentum), 1e-14 * found.census[1].mass * 300);
    EXPECT_LT(norm(moment), 1e-14 * found.census[1].mass * 300e3);
    const Placed at_rest = placed({.speed = 300, .centre_of_mass_frame = false});
    EXPECT_EQ(at_rest.bodies[0].velocity, Point{});
    EXPECT_EQ(centre(at_rest.bodies[0].shape), Point{});
}

// Figures by hand: G = 6.6743e-11, masses those of the particles.
TEST(Impacts, EnergyAndSpeeds) {
    const Placed found = placed({.speed = 100, .speed_at_infinity = true});
    const double M = found.census[0].mass, m = found.census[1].mass;
    const double escape2 = 2 * 6.6743e-11 * (M + m) / 80e3;
    EXPECT_NEAR(M / (4.0 / 3 * pi * std::pow(50e3, 3) * 2700), 1, 0.02);
    EXPECT_NEAR(found.impact.escape_speed, std::sqrt(escape2), 1e-9);
    EXPECT_NEAR(found.impact.contact.speed, std::sqrt(1e4 + escape2), 1e-9);
    EXPECT_NEAR(found.impact.speed_at_infinity, 100, 1e-9);
    EXPECT_NEAR(found.impact.specific_energy, 0.5 * M * m / (M + m) * (1e4 + escape2) / (M + m), 1e-9);
    EXPECT_NEAR(found.impact.energy_per_target, 0.5 * m * (1e4 + escape2) / M, 1e-9);
}

TEST(Impacts, ThatCannotBeAreRefused) {
    std::vector<Body> bodies{ball(50e3, 2700, 6e3), ball(30e3, 2000, 6e3)};
    const std::vector<BodyCensus> census = take_census(bodies, 3, 1);
    const auto fault = [&](const ImpactPlan& plan) { return plan_impact(plan, bodies, census, 3).key; };
    EXPECT_EQ(fault({.speed = 300, .offset = 81e3}), "offset");
    EXPECT_EQ(fault({.speed = 300, .distance = 79e3}), "distance");
    EXPECT_EQ(fault({.speed = 1, .distance = 300e3, .along_orbit = true}), "distance");
    EXPECT_EQ(fault({.speed = 1, .along_orbit = true}), "gap");
}

// Angular momentum of a spinning body about its centre of mass: I omega with the inertia of its points. The
// momentum vanishes though the points do not balance about the centre of the shape.
TEST(Spin, GivesTheAngularMomentumOfTheLattice) {
    Body body = ball(1, 1000, 0.13);
    body.shape = EllipsoidShape{{3, 2, 1}, {1, 0.7, 0.5}, rotation_about(0, 0.5)};
    body.jitter = 0.2;
    body.spin = {1e-3, -2e-3, 3e-3};
    const Communicator comm(MPI_COMM_SELF);
    talus::Setup setup;
    setup.materials = {Material{}};
    ParticleSet prototype("sph", 3);
    add_fields(prototype, setup);
    const ParticleSet particles = make_particles(comm, {body}, setup.materials, prototype, setup.sph, 1);
    const BodyCensus census = take_census({body}, 3, 1).front();
    EXPECT_EQ(census.count, particles.size());
    EXPECT_GT(norm(minus(census.centre_of_mass, {3, 2, 1})), 1e-5) << "the test needs an unbalanced body";
    Point momentum{}, angular{};
    std::array<Point, 3> second{};
    double mass = 0;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        Point arm{}, v{};
        for (int a = 0; a < 3; ++a) {
            arm[static_cast<std::size_t>(a)] = particles.data(field::position, a)[i];
            v[static_cast<std::size_t>(a)] = particles.data(field::velocity, a)[i];
        }
        arm = minus(arm, census.centre_of_mass);
        const double m = particles.data(field::mass)[i];
        mass += m;
        momentum = plus(momentum, times(m, v));
        angular = plus(angular, times(m, cross(arm, v)));
        for (std::size_t a = 0; a < 3; ++a) second[a] = plus(second[a], times(m * arm[a], arm));
    }
    EXPECT_NEAR(mass, census.mass, 1e-12 * mass);
    EXPECT_LT(norm(momentum), 1e-13 * mass * norm(body.spin));
    const double trace = second[0][0] + second[1][1] + second[2][2];
    for (std::size_t a = 0; a < 3; ++a)
        EXPECT_NEAR(angular[a], trace * body.spin[a] - dot(second[a], body.spin), 1e-12 * norm(angular));
}

// 2700 kg/m3: 3 pi/(G rho) = 7231.8^2 s2.
TEST(Spin, BreakUp) { EXPECT_NEAR(rotation_period(break_up_spin(2700)), 7231.8, 0.1); }

}  // namespace
}  // namespace talus::test
