#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "io/scene.hpp"
#include "src/rigid_bodies.hpp"
#include "src/setup/water_scene.hpp"

/// Rigid bodies of particles against each other and against walls, far from the water of their scene.
namespace talus::test {
namespace {

using dem::Vector3;

const std::string linear = "law = \"linear\"\nstiffness = 1e5", hertz = "law = \"hertz\"";

/// A puddle far away, and bodies of rubber.
std::string scene(const std::string& bodies, const std::string& law = linear) {
    return R"(dimension = 3
[water]
greatest_speed = 2
artificial_viscosity = 0.05
[[body]]
name = "puddle"
shape = "box"
lower = [-9, -9, -9]
upper = [-8.8, -8.8, -8.8]
lattice = "cubic"
spacing = 0.02
[dem]
)" + law + R"(
[materials.rubber]
density = 800
restitution = 0.6
friction = 0.4
)" + (law == hertz ? "youngs_modulus = 1e6\npoisson_ratio = 0.3\n" : "") +
           "[run]\nend_time = 1\n" + bodies;
}

std::string cube(const std::string& name, const std::string& lower, const std::string& upper,
                 const std::string& velocity, const std::string& spin = "[0, 0, 0]") {
    return "[[body]]\nname = \"" + name + "\"\nshape = \"box\"\nlower = " + lower + "\nupper = " + upper +
           "\nlattice = \"cubic\"\nwall = \"no_slip\"\n[body.rigid]\nmaterial = \"rubber\"\nvelocity = " +
           velocity + "\nspin = " + spin + "\n";
}
std::string ball(const std::string& name, const std::string& centre, const std::string& velocity) {
    return "[[body]]\nname = \"" + name + "\"\nshape = \"sphere\"\ncentre = " + centre +
           "\nradius = 0.1\nlattice = \"cubic\"\nwall = \"no_slip\"\n[body.rigid]\nmaterial = \"rubber\"\n"
           "velocity = " +
           velocity + "\n";
}
constexpr const char* plane =
    "[[wall]]\nkind = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\nmaterial = \"rubber\"\n";

/// The bodies alone, moved on by steps as long as those of the water would be.
class Moving {
  public:
    explicit Moving(const std::string& text)
        : parsed_(Scene::parse(text, "bodies.toml")),
          read_(read_water_scene(comm_, parsed_)),
          bodies_(comm_, read_.simulation.rigid, read_.simulation.box, read_.simulation.settings) {}

    void run(double end, double dt = 5e-4) {
        for (double t = 0; t < end; t += dt) bodies_.move(t, dt);
    }
    const rigid::Body& body(std::size_t k) const { return bodies_.body(k); }
    RigidTotals operator[](std::size_t k) const { return bodies_.totals(k); }
    Vector3<> momentum() const {
        Vector3<> sum;
        for (std::size_t k = 0; k < bodies_.count(); ++k) sum += body(k).mass * (*this)[k].state.velocity;
        return sum;
    }
    Vector3<> angular_momentum() const {
        Vector3<> sum;
        for (std::size_t k = 0; k < bodies_.count(); ++k) {
            const rigid::State& s = (*this)[k].state;
            sum += s.angular_momentum + cross(s.centre, body(k).mass * s.velocity);
        }
        return sum;
    }
    double energy() const {
        double sum = 0;
        for (std::size_t k = 0; k < bodies_.count(); ++k) sum += (*this)[k].kinetic_energy;
        return sum;
    }

  private:
    Communicator comm_{MPI_COMM_SELF};
    Scene parsed_;
    WaterScene read_;
    RigidBodies bodies_;
};

// m L^2/6 of an even cube, 2/5 m R^2 of a ball.
TEST(RigidBodies, HaveMassAndMoments) {
    const Moving moving(scene(cube("cube", "[0, 0, 0]", "[0.2, 0.2, 0.2]", "[0, 0, 0]") +
                              ball("ball", "[0.5, 0, 0]", "[0, 0, 0]")));
    EXPECT_NEAR(moving.body(0).mass, 800 * 0.008, 1e-12);
    EXPECT_NEAR(moving.body(0).inertia.x, 800 * 0.008 * 0.04 / 6, 1e-12);
    EXPECT_NEAR(moving.body(0).inertia.z, 800 * 0.008 * 0.04 / 6, 1e-12);
    const double mass = 800 * 4.0 / 3 * std::numbers::pi * 1e-3;
    EXPECT_NEAR(moving.body(1).mass, mass, 1e-12);
    EXPECT_NEAR(moving.body(1).inertia.x, 0.4 * mass * 0.01, 1e-12);
    EXPECT_EQ(moving.body(0).spheres.size(), 488u);
    EXPECT_EQ(moving.body(1).spheres.size(), 1u);
}

// Speeds after a central impact are those that the coefficient of restitution says, whether one sphere
// touches or a hundred at once; 0.5 % of the finite steps.
TEST(RigidBodies, BounceAsTheirRestitutionSays) {
    for (const std::string& law : {linear, hertz}) {
        Moving flat(scene(cube("cube", "[0, 0, 0.05]", "[0.2, 0.2, 0.25]", "[0, 0, -1]") + plane, law));
        flat.run(0.15);
        EXPECT_NEAR(flat[0].state.velocity.z, 0.6, 0.005) << law;
        EXPECT_NEAR(norm(flat[0].turning), 0, 1e-6);
        Moving round(scene(ball("ball", "[0, 0, 0.15]", "[0, 0, -1]") + plane, law));
        round.run(0.15);
        EXPECT_NEAR(round[0].state.velocity.z, 0.6, 0.005) << law;
        Moving two(
            scene(ball("one", "[0, 0, 0]", "[1, 0, 0]") + ball("two", "[0.25, 0, 0]", "[0, 0, 0]"), law));
        two.run(0.15);
        EXPECT_NEAR(two[0].state.velocity.x, 0.2, 0.005) << law;
        EXPECT_NEAR(two[1].state.velocity.x, 0.8, 0.005) << law;
    }
}

// A turning cube meets another off its centre: momentum and angular momentum stay to rounding, energy falls.
TEST(RigidBodies, ConserveMomentumInCollisions) {
    Moving moving(scene(cube("one", "[0, 0, 0]", "[0.2, 0.2, 0.2]", "[1, 0.1, 0]", "[1, 5, 3]") +
                        cube("two", "[0.26, 0.12, 0.04]", "[0.46, 0.32, 0.24]", "[0, 0, 0]")));
    const Vector3<> momentum = moving.momentum(), angular = moving.angular_momentum();
    const double energy = moving.energy();
    moving.run(0.3);
    EXPECT_LT(norm(moving.momentum() - momentum), 1e-13 * norm(momentum));
    EXPECT_LT(norm(moving.angular_momentum() - angular), 1e-13 * norm(momentum));
    EXPECT_GT(norm(moving[1].state.velocity), 0.1);
    EXPECT_GT(norm(moving[1].turning), 0.1);
    EXPECT_LT(moving.energy(), 0.95 * energy);
    EXPECT_GT(moving.energy(), 0.3 * energy);
}

// Nothing acts across a gap.
TEST(RigidBodies, PassWhatTheyDoNotTouch) {
    Moving moving(scene(ball("ball", "[0, 0, 0.1001]", "[1, 0, 0]") + plane));
    moving.run(0.1);
    EXPECT_EQ(moving[0].state.velocity, (Vector3<>{1, 0, 0}));
    EXPECT_EQ(norm(moving[0].turning), 0);
}

}  // namespace
}  // namespace talus::test
