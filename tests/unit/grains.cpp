#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "comm/communicator.hpp"
#include "tests/support/grain_scene.hpp"

/// Grains under the whole step: law, memory, motion, walls. What laws alone do is tested beside them.
namespace talus::test {
namespace {

using dem::Vector3;

const dem::GrainMaterial limestone{
    .name = "limestone", .density = 2500, .youngs_modulus = 20e9, .poisson_ratio = 0.25, .friction = 0.35};
const dem::GrainMaterial aluminium{
    .name = "aluminium", .density = 2699, .youngs_modulus = 70e9, .poisson_ratio = 0.3};

dem::Wall floor_of(std::uint8_t material) { return {"floor", material, dem::PlaneShape{{}, {0, 0, 1}}, {}}; }

GrainSimulation started(const Communicator& comm, const GrainSetup& setup,
                        const std::vector<GrainState>& grains) {
    return {comm, setup, grain_set(comm, grains)};
}

/// Greatest overlap, greatest force and duration of a collision of grain 0, from its own motion.
struct Collision {
    double overlap = 0, force = 0, duration = 0;
};

template <class Overlap>
Collision collide(GrainSimulation& run, double mass, Overlap&& overlap_of) {
    run.start();
    Collision found;
    bool touched = false;
    for (int k = 0; k < 100000; ++k) {
        const Vector3<> before = state_of(run, 0).velocity;
        run.step();
        const GrainState now = state_of(run, 0);
        const double overlap = overlap_of(now);
        found.overlap = std::max(found.overlap, overlap);
        found.force = std::max(found.force, mass * norm(now.velocity - before) / run.time_step());
        found.duration += overlap > 0 ? run.time_step() : 0;
        touched = touched || overlap > 0;
        if (touched && overlap < 0) break;
    }
    return found;
}

// Y. C. Chung, J. Y. Ooi, Granular Matter 13 (2011) 643, tests 1 and 2: elastic normal impact. References are
// the closed forms of Hertz's law; 0.3 % is what other codes pass the same test with.
TEST(Grains, ElasticImpactOfTwoSpheres) {
    const Communicator comm(MPI_COMM_SELF);
    const GrainState grain{{-0.010001, 0, 0}, {10, 0, 0}, {}, 0.01, 2500};
    GrainState other = grain;
    other.position = -grain.position;
    other.velocity = -grain.velocity;
    GrainSimulation run = started(comm, grain_setup({limestone}, 0.01, 1e-7), {grain, other});
    const Collision found =
        collide(run, mass_of(grain), [](const GrainState& s) { return 2 * (0.01 - std::abs(s.position.x)); });
    EXPECT_NEAR(found.overlap, 368.30e-6, 0.003 * 368.30e-6);
    EXPECT_NEAR(found.force, 7.108e3, 0.003 * 7.108e3);
    EXPECT_NEAR(found.duration, 54.20e-6, 0.003 * 54.20e-6);
    EXPECT_NEAR(state_of(run, 0).velocity.x, -10, 1e-5);
}

TEST(Grains, ElasticImpactOnAWall) {
    const Communicator comm(MPI_COMM_SELF);
    // A rigid plane: the modulus of the pair is that of the sphere alone.
    dem::GrainMaterial rigid = aluminium;
    rigid.youngs_modulus = 1e30;
    const GrainState grain{{0, 0, 0.100001}, {0, 0, -0.2}, {}, 0.1, 2699};
    GrainSetup setup = grain_setup({aluminium, rigid}, 0.1, 1e-6);
    setup.walls.push_back(floor_of(1));
    GrainSimulation run = started(comm, setup, {grain});
    const Collision found =
        collide(run, mass_of(grain), [](const GrainState& s) { return 0.1 - s.position.z; });
    EXPECT_NEAR(found.overlap, 49.72e-6, 0.003 * 49.72e-6);
    EXPECT_NEAR(found.force, 11.370e3, 0.003 * 11.370e3);
    EXPECT_NEAR(found.duration, 731.6e-6, 0.003 * 731.6e-6);
}

// The same, test 7: opposite spins that make no slip; nothing tangential may happen.
TEST(Grains, OppositeSpinsWithoutSlipStay) {
    const Communicator comm(MPI_COMM_SELF);
    dem::GrainMaterial material = aluminium;
    material.restitution = 0.5;
    material.friction = 0.4;
    for (const double spin : {0.175, 2.0, 22.86}) {
        const GrainState grain{{-0.100001, 0, 0}, {0.2, 0, 0}, {0, spin, 0}, 0.1, 2699};
        GrainState other = grain;
        other.position = -grain.position;
        other.velocity = -grain.velocity;
        other.angular_velocity = -grain.angular_velocity;
        GrainSimulation run = started(comm, grain_setup({material}, 0.1, 1e-6), {grain, other});
        collide(run, mass_of(grain), [](const GrainState& s) { return 2 * (0.1 - std::abs(s.position.x)); });
        const GrainState end = state_of(run, 0);
        EXPECT_NEAR(end.angular_velocity.y, spin, 1e-9 * spin);
        EXPECT_NEAR(end.velocity.z, 0, 1e-9 * spin);
        EXPECT_NEAR(end.velocity.x, -0.1, 0.001);  // e = 0.5
    }
}

/// Velocity and spin of a ball after an impact on a floor at an angle from the normal.
GrainState oblique_impact(double angle, const dem::GrainMaterial& material, double time_step) {
    const Communicator comm(MPI_COMM_SELF);
    const double speed = 3.9, radius = 0.0025;
    const GrainState grain{{0, 0, radius * 1.0001},
                           {speed * std::sin(angle), 0, -speed * std::cos(angle)},
                           {},
                           radius,
                           material.density};
    GrainSetup setup = grain_setup(
        {material, {"rigid", 0, 1e30, 0.3, material.restitution, material.friction}}, radius, time_step);
    setup.walls.push_back(floor_of(1));
    GrainSimulation run = started(comm, setup, {grain});
    collide(run, mass_of(grain), [&](const GrainState& s) { return radius - s.position.z; });
    return state_of(run, 0);
}

const dem::GrainMaterial oxide{.name = "aluminium oxide",
                               .density = 4000,
                               .youngs_modulus = 380e9,
                               .poisson_ratio = 0.23,
                               .restitution = 0.98,
                               .friction = 0.092};

// The same, test 4: beyond 32.5 degrees the ball slides throughout, which has a closed form.
TEST(Grains, SlidingImpact) {
    const double e = oxide.restitution, mu = oxide.friction, radius = 0.0025, speed = 3.9;
    for (const double degrees : {40.0, 60.0, 80.0}) {
        const double angle = degrees * std::numbers::pi / 180;
        const GrainState end = oblique_impact(angle, oxide, 1e-8);
        EXPECT_NEAR(end.velocity.x, speed * std::sin(angle) * (1 - mu * (1 + e) / std::tan(angle)),
                    0.002 * speed)
            << degrees;
        EXPECT_NEAR(std::abs(end.angular_velocity.y), 2.5 * mu * (1 + e) * speed * std::cos(angle) / radius,
                    0.01 * 2.5 * mu * (1 + e) * speed * std::cos(angle) / radius)
            << degrees;
    }
}

TEST(Grains, NoImpactGainsEnergy) {
    dem::GrainMaterial material = oxide;
    material.restitution = 1;
    for (const double friction : {0.092, 0.5}) {
        material.friction = friction;
        for (int degrees = 0; degrees < 90; degrees += 4) {
            const GrainState end = oblique_impact(degrees * std::numbers::pi / 180, material, 2e-8);
            const double spin = norm(end.angular_velocity) * end.radius;
            const double energy = dot(end.velocity, end.velocity) + 0.4 * spin * spin;
            EXPECT_LT(energy, 3.9 * 3.9 * (1 + 1e-4)) << degrees << " degrees, friction " << friction;
        }
    }
}

// Elastic, without friction: the error of the rebound must fall with the square of the step or faster, though
// Hertz's law begins with a kink in its stiffness.
TEST(Grains, StepIsOfSecondOrder) {
    dem::GrainMaterial material = oxide;
    material.restitution = 1;
    material.friction = 0;
    const auto error = [&](double step) {
        double worst = 0;  // over the phase of the first touch
        for (int phase = 0; phase < 8; ++phase) {
            const GrainState end = oblique_impact(0, material, step * (1 + 0.01 * phase));
            worst = std::max(worst, std::abs(end.velocity.z / 3.9 - 1));
        }
        return worst;
    };
    const double coarse = error(4e-7), fine = error(1e-7);
    EXPECT_LT(fine, 1e-3);
    EXPECT_GT(std::log(coarse / fine) / std::log(4.0), 1.8) << coarse << " " << fine;
}

const dem::GrainMaterial soft_glass{.name = "glass",
                                    .density = 2500,
                                    .youngs_modulus = 1e7,
                                    .poisson_ratio = 0.2,
                                    .restitution = 0.7,
                                    .friction = 0.5};

// A box of grains thrown at each other: forces act on both sides alike.
TEST(Grains, MomentumIsKept) {
    const Communicator comm(MPI_COMM_SELF);
    std::vector<GrainState> grains;
    for (int k = 0; k < 125; ++k)
        grains.push_back({{0.0105 * (k % 5), 0.0105 * (k / 5 % 5), 0.0105 * (k / 25)},
                          {std::sin(3.0 * k), std::cos(5.0 * k), std::sin(7.0 * k)},
                          {},
                          0.005,
                          2500});
    GrainSetup setup = grain_setup({soft_glass}, 0.005, 1e-6);
    setup.box = {3,
                 {-0.005, -0.005, -0.005},
                 {0.048, 0.048, 0.048},
                 {Boundary::periodic, Boundary::periodic, Boundary::periodic}};
    GrainSimulation run = started(comm, setup, grains);
    run.start();
    const GrainTotals before = run.totals();
    for (int k = 0; k < 3000; ++k) run.step();
    const GrainTotals after = run.totals();
    EXPECT_LT(after.kinetic_energy + after.rotational_energy, 0.8 * before.kinetic_energy);
    EXPECT_GT(run.evaluated_contacts(), 10000U);
    const double scale = before.mass * before.greatest_speed;
    for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(after.momentum[a], before.momentum[a], 1e-13 * scale);
}

TEST(Grains, ListsMadeAtOtherTimesChangeNothing) {
    const Communicator comm(MPI_COMM_SELF);
    std::vector<GrainState> grains;
    for (int k = 0; k < 27; ++k)
        grains.push_back({{0.0101 * (k % 3), 0.0101 * (k / 3 % 3), 0.0101 * (k / 9)},
                          {std::sin(3.0 * k), std::cos(5.0 * k), 0},
                          {},
                          0.005,
                          2500});
    std::vector<GrainState> ends;
    std::vector<std::uint64_t> lists;
    for (const double skin : {0.00005, 0.0005, 0.002}) {
        GrainSetup setup = grain_setup({soft_glass}, 0.005, 1e-6);
        setup.skin = skin;
        GrainSimulation run = started(comm, setup, grains);
        run.start();
        for (int k = 0; k < 2000; ++k) run.step();
        ends.push_back(state_of(run, 13));
        lists.push_back(run.list_count());
    }
    EXPECT_GT(lists[0], 4 * lists[1]);
    for (const GrainState& end : ends) {
        EXPECT_EQ(end.position, ends[0].position);
        EXPECT_EQ(end.angular_velocity, ends[0].angular_velocity);
    }
}

/// A horizontal square of two triangles.
std::shared_ptr<const dem::TriangleSurface> square(double half) {
    dem::TriangleMesh mesh;
    mesh.vertices = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return std::make_shared<const dem::TriangleSurface>(mesh, 0.5, 0.01);
}

// At steps far above the stable one: behind a plane by any distance, through sheets that are touched from
// both sides by less than a radius, by the grain's motion or the wall's.
TEST(Grains, ThroughAWallStopsTheRun) {
    const Communicator comm(MPI_COMM_SELF);
    dem::GrainMaterial soft = limestone;
    soft.youngs_modulus = 1e5;  // is not thrown back at once
    const dem::WallShape disk = dem::RevolvedShape({}, {0, 0, 1}, {{0, 0}, {1, 0}}, 0.5);
    dem::WallMotion rising;
    rising.velocity = {0, 0, 100};
    struct Case {
        dem::Wall wall;
        double height, velocity, time_step;
    };
    for (const Case& one :
         {Case{floor_of(0), 0.02, -100, 1e-3}, Case{{"floor", 0, disk, {}}, 0.0145, -100, 1e-4},
          Case{{"floor", 0, square(1), {}}, 0.0145, -100, 1e-4},
          Case{{"floor", 0, square(1), rising}, 0.0145, 0, 1e-4}}) {
        GrainSetup setup = grain_setup({soft}, 0.01, one.time_step);
        setup.walls.push_back(one.wall);
        GrainSimulation run =
            started(comm, setup, {{{0.1, 0.2, one.height}, {0, 0, one.velocity}, {}, 0.01, 2500}});
        run.start();
        try {
            for (int k = 0; k < 4; ++k) run.step();
            ADD_FAILURE() << "a grain went through the wall unseen";
        } catch (const AgreedError& error) {
            EXPECT_NE(std::string(error.what()).find("grain 0 at"), std::string::npos) << error.what();
            EXPECT_NE(std::string(error.what()).find("has left through wall 'floor'"), std::string::npos)
                << error.what();
        }
    }
}

TEST(Grains, ForceBeyondAllBoundsStopsTheRun) {
    const Communicator comm(MPI_COMM_SELF);
    const GrainState grain{{0, 0, 0}, {}, {}, 0.01, 2500},
        inside{{0.005, 0, 0}, {-1e7, 0, 0}, {}, 0.01, 2500};
    dem::GrainMaterial damped = limestone;
    damped.restitution = 0.1;
    GrainSimulation run = started(comm, grain_setup({damped}, 0.01, 1e-7), {grain, inside});
    try {
        run.start();
        run.step();
        FAIL() << "no fault was found";
    } catch (const AgreedError& error) {
        EXPECT_NE(std::string(error.what()).find("between grain 0 at (0, 0, 0) m and grain 1"),
                  std::string::npos)
            << error.what();
    }
}

// What cannot be counted on stops the run, and says whose it is.
TEST(Grains, AGrainThatMovesNoFiniteWayStopsTheRun) {
    const Communicator comm(MPI_COMM_SELF);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const auto& [velocity, spin, fault] : {std::tuple{nan, 0.0, "velocity of grain 1 is not finite"},
                                                {0.0, nan, "angular_velocity of grain 1 is not finite"},
                                                {1e300, 0.0, "grain 1 moves too fast to follow"}}) {
        GrainSimulation run =
            started(comm, grain_setup({soft_glass}, 0.005, 1e-6),
                    {{{}, {}, {}, 0.005, 2500}, {{1, 0, 0}, {0, velocity, 0}, {spin, 0, 0}, 0.005, 2500}});
        try {
            run.start();
            for (int k = 0; k < 3; ++k) run.step();
            ADD_FAILURE() << "no stop: " << fault;
        } catch (const AgreedError& error) {
            EXPECT_NE(std::string(error.what()).find(fault), std::string::npos) << error.what();
        }
    }
}

}  // namespace
}  // namespace talus::test
