#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "src/setup/grain_scene.hpp"
#include "tests/support/grain_scene.hpp"

/// What a scene chooses under [dem] beyond Hertz's law and friction, through the whole step: closed forms.
namespace talus::test {
namespace {

using dem::Vector3;
constexpr double pi = std::numbers::pi, g = 9.81, radius = 5e-3, density = 2500;

/// A scene of one material with a body held and one that moves, over a floor; grains are put in by the test.
GrainSetup setup_of(const std::string& dem, const std::string& material, const std::string& gravity) {
    const Communicator comm(MPI_COMM_SELF);
    const std::string body =
        "[[grains]]\nmaterial = \"m\"\nradius = 0.005\nshape = \"box\"\nlower = [0, 0, 0]\nupper = [0.1, "
        "0.1, 0.1]\n";
    const std::string text =
        "[materials.m]\ndensity = 2500\nyoungs_modulus = 1e7\npoisson_ratio = 0.3\nrestitution = 0.5\n" +
        material + "\n[dem]\ntime_step = 1e-5\ngravity = " + gravity + "\n" + dem + "\n" + body + body +
        "held = true\n[[wall]]\nmaterial = \"m\"\nname = \"floor\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\n"
        "[run]\nend_time = 1\n";
    return read_grain_scene(comm, Scene::parse(text, "s.toml")).simulation;
}

GrainSimulation started(const Communicator& comm, const GrainSetup& setup,
                        const std::vector<GrainState>& grains) {
    GrainSimulation run(comm, setup, grain_set(comm, grains));
    run.start();
    return run;
}

void advance(GrainSimulation& run, double duration) {
    for (double end = run.time() + duration; run.time() < end;) run.step();
}

constexpr double effective_modulus = 1e7 / (2 * (1 - 0.3 * 0.3));

/// On the floor, pressed in as its weight says.
GrainState resting() {
    const double weight = mass_of({{}, {}, {}, radius, density}) * g;
    const double depth = std::pow(0.75 * weight / (effective_modulus * std::sqrt(radius)), 2.0 / 3);
    return {{0, 0, radius - depth}, {}, {}, radius, density};
}

TEST(GrainLawsOfScenes, ConstantTorqueStopsARollingGrain) {
    // 0.7 v^2/(mu_r g) = 0.02854 m, depth of contact 1.7e-3 of the radius.
    const Communicator comm(MPI_COMM_SELF);
    const GrainSetup setup =
        setup_of("rolling = \"constant_torque\"", "friction = 0.8\nrolling_friction = 0.1", "[0, 0, -9.81]");
    GrainState grain = resting();
    grain.velocity = {0.2, 0, 0};
    grain.angular_velocity = {0, 0.2 / radius, 0};
    GrainSimulation run = started(comm, setup, {grain});
    advance(run, 0.3);  // after 0.2854 s it has stopped
    EXPECT_NEAR(state_of(run, 0).position.x / (0.7 * 0.04 / (0.1 * g)), 1, 5e-3);
    EXPECT_LT(std::abs(state_of(run, 0).velocity.x), 2e-4);
}

TEST(GrainLawsOfScenes, TwistingStopsASpin) {
    // Torque 2/3 a mu m g on 2/5 m R^2: the spin falls by 5/3 a mu g/R^2 a second.
    const Communicator comm(MPI_COMM_SELF);
    const GrainSetup setup = setup_of("twisting = \"contact_area\"", "friction = 0.5", "[0, 0, -9.81]");
    GrainState grain = resting();
    const double a = std::sqrt(radius * (radius - grain.position.z));
    const double rate = 5.0 / 3 * a * 0.5 * g / (radius * radius), spin = 100;
    grain.angular_velocity = {0, 0, spin};
    GrainSimulation run = started(comm, setup, {grain});
    advance(run, 0.5 * spin / rate);
    EXPECT_NEAR(state_of(run, 0).angular_velocity.z / spin, 0.5, 2e-3);
    // Then its contact swings as a spring k = 1/2 a^2 8 G* a that is released from the greatest torque.
    const double shear_modulus = 1e7 / 2.6, stiffness = 4 * shear_modulus / (2 * 1.7) * a * a * a;
    const double inertia = 0.4 * mass_of(grain) * radius * radius;
    advance(run, 0.55 * spin / rate);
    EXPECT_LT(std::abs(state_of(run, 0).angular_velocity.z), rate * std::sqrt(inertia / stiffness));
    EXPECT_LT(norm(state_of(run, 0).velocity), 1e-6);
}

/// A grain that hangs under a held one in no more than contact.
std::vector<GrainState> hanging() {
    return {{{0, 0, 0.1 - 2 * radius + 1e-8}, {}, {}, radius, density, 0},
            {{0, 0, 0.1}, {}, {}, radius, density, 1}};
}

TEST(GrainLawsOfScenes, AdhesionCarriesUpToItsPullOff) {
    // Pull-off of two equal spheres, R* = R/2: 3/2 pi w R* (Johnson, Kendall, Roberts), 2 pi w R* (Derjaguin,
    // Muller, Toporov), A R*/(6 s^2) (Hamaker).
    const Communicator comm(MPI_COMM_SELF);
    const double weight = mass_of(hanging()[0]) * g, R = radius / 2, s = 1e-7;
    struct Case {
        std::string dem, key;
        double force;  // of a value of 1
    };
    for (const Case& c :
         {Case{"adhesion = \"jkr\"", "work_of_adhesion", 1.5 * pi * R},
          Case{"adhesion = \"dmt\"", "work_of_adhesion", 2 * pi * R},
          Case{"adhesion = \"van_der_waals\"\nseparation = 1e-7", "hamaker_constant", R / (6 * s * s)}})
        for (const double share : {0.97, 1.03}) {
            const double value = weight / share / c.force;
            const GrainSetup setup =
                setup_of(c.dem, "friction = 0.5\n" + c.key + " = " + std::to_string(value * 1e20) + "e-20",
                         "[0, 0, -9.81]");
            GrainSimulation run = started(comm, setup, hanging());
            advance(run, 0.2);
            const double fallen = 0.1 - 2 * radius - state_of(run, 0).position.z;
            EXPECT_EQ(fallen > 0.01, share > 1) << c.dem << ", weight over pull-off " << share;
            EXPECT_EQ(run.totals().contacts, share > 1 ? 0U : 1U) << c.dem;
        }
}

TEST(GrainLawsOfScenes, AdhesiveGrainsRestWhereTheirForcesBalance) {
    // F = 0 at a^3 = 9 pi w R*^2/(2 E*), overlap a^2/(3 R*).
    const Communicator comm(MPI_COMM_SELF);
    const GrainSetup setup =
        setup_of("adhesion = \"jkr\"", "friction = 0.5\nwork_of_adhesion = 0.1", "[0, 0, 0]");
    GrainSimulation run = started(comm, setup,
                                  {{{-radius + 1e-9, 0, 1}, {}, {}, radius, density},
                                   {{radius - 1e-9, 0, 1}, {}, {}, radius, density}});
    advance(run, 0.2);
    const double R = radius / 2, a = std::cbrt(4.5 * pi * 0.1 * R * R / effective_modulus);
    const double overlap = 2 * radius + state_of(run, 0).position.x - state_of(run, 1).position.x;
    EXPECT_NEAR(overlap / (a * a / (3 * R)), 1, 1e-3);
}

TEST(GrainLawsOfScenes, FilmTakesTheSpeedThatItsIntegralSays) {
    // m dv/dh = c (1/h - 1/H), c = 6 pi eta R^2: v = v_0 + (c/m) (ln(H/h) - (H - h)/H).
    const Communicator comm(MPI_COMM_SELF);
    GrainSetup setup = setup_of("film = \"viscous\"\nviscosity = 0.1\nroughness = 1e-6\nfilm_reach = 1e-4",
                                "friction = 0", "[0, 0, 0]");
    setup.time_step = 1e-7;
    const double H = 1e-4;
    GrainState grain{{0, 0, radius + H * 1.001}, {0, 0, -0.1}, {}, radius, density};
    GrainSimulation run = started(comm, setup, {grain});
    while (state_of(run, 0).position.z - radius > 1e-5) run.step();
    const double h = state_of(run, 0).position.z - radius, c = 6 * pi * 0.1 * radius * radius;
    const double expected = -0.1 + c / mass_of(grain) * (std::log(H / h) - (H - h) / H);
    EXPECT_LT(expected, -0.02);
    EXPECT_GT(expected, -0.08);
    EXPECT_NEAR(state_of(run, 0).velocity.z / expected, 1, 1e-3);
    EXPECT_EQ(run.totals().wall_contacts, 0U);
}

}  // namespace
}  // namespace talus::test
