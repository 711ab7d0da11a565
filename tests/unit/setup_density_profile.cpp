#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "src/setup/scene_setup.hpp"

/// Balls whose density falls outward: the profiles, their particles, and what is said where there is none.
namespace talus::test {
namespace {

constexpr DensityProfile profiles[] = {DensityProfile::even, DensityProfile::inverse_radius,
                                       DensityProfile::polytrope_1};

TEST(DensityProfiles, MassIsTheIntegralOfTheDensity) {
    for (const DensityProfile profile : profiles) {
        EXPECT_NEAR(enclosed_mass(profile, 1), 1, 1e-15);
        for (const double r : {0.01, 0.3, 0.7, 0.99}) {
            const double step = 1e-5;
            const double slope =
                (enclosed_mass(profile, r + step) - enclosed_mass(profile, r - step)) / (2 * step);
            EXPECT_NEAR(slope, 3 * r * r * density_at(profile, r), 1e-8);
            EXPECT_NEAR(radius_enclosing(profile, enclosed_mass(profile, r)), r, 1e-10);
        }
        EXPECT_NEAR(radius_enclosing(profile, 1), 1, 1e-7);
    }
}

TEST(DensityProfiles, PolytropeIsInEquilibrium) {
    const double G = 3, R = 2, M = 5, mean = M / (4.0 / 3 * std::numbers::pi * R * R * R);
    const double K = polytropic_constant(R, G);
    for (const double r : {0.1, 0.5, 0.9}) {
        const auto pressure = [&](double at) {
            return K * std::pow(mean * density_at(DensityProfile::polytrope_1, at), 2);
        };
        const double step = 1e-5, slope = (pressure(r + step) - pressure(r - step)) / (2 * step * R);
        const double weight = G * M * enclosed_mass(DensityProfile::polytrope_1, r) / (r * r * R * R) * mean *
                              density_at(DensityProfile::polytrope_1, r);
        EXPECT_NEAR(slope, -weight, 1e-8 * weight);
    }
}

constexpr const char* gas = R"([materials.gas]
density = 2
equation_of_state = { kind = "ideal_gas", gamma = 3 }
)";
constexpr const char* rock = R"([materials.rock]
density = 2
shear_modulus = 1
equation_of_state = { kind = "linear", sound_speed = 1 }
)";

SceneSetup read(const Communicator& comm, const std::string& body, const std::string& rest) {
    const std::string material = body.find("\"rock\"") == std::string::npos ? gas : rock;
    return read_scene(
        comm, Scene::parse("[run]\nend_time = 1\n" + rest + material + "[[body]]\n" + body, "s.toml"));
}
constexpr const char* gravity = "[gravity]\nconstant = 5\n";
constexpr const char* ball =
    "material = \"gas\"\nshape = \"sphere\"\nradius = 2\ncentre = [1, 0, 0]\nspacing = 0.2\n";

/// Place of a particle relative to the centre of the ball, in units of its radius.
Point arm(const ParticleSet& particles, std::size_t i) {
    Point x{};
    for (int a = 0; a < 3; ++a) x[static_cast<std::size_t>(a)] = particles.own(field::position, a)[i];
    return times(0.5, minus(x, {1, 0, 0}));
}

TEST(DensityProfiles, ParticlesFollow) {
    const Communicator comm = world();
    const ParticleSet even = make_particles(comm, read(comm, ball, gravity));
    for (const std::string name : {"inverse_radius", "polytrope_1"}) {
        const SceneSetup setup = read(comm, ball + ("density_profile = \"" + name + "\"\n"), gravity);
        const DensityProfile profile = setup.bodies[0].profile;
        const ParticleSet particles = make_particles(comm, setup);
        ASSERT_EQ(particles.size(), even.size());
        for (std::size_t i = 0; i < particles.size(); ++i) {
            const Point start = arm(even, i), end = arm(particles, i);
            const double r = norm(end), density = 2 * density_at(profile, r);
            EXPECT_NEAR(enclosed_mass(profile, r), std::pow(norm(start), 3), 1e-12);
            EXPECT_NEAR(dot(start, end), norm(start) * r, 1e-14);
            EXPECT_EQ(particles.own(field::mass)[i], even.own(field::mass)[i]);
            const double h = particles.own(field::smoothing_length)[i];
            EXPECT_NEAR(density * h * h * h, 2 * 0.2 * 0.2 * 0.2, 1e-10);
            const double equilibrium = polytropic_constant(2, 5) * density / 2;  // K rho/(gamma - 1)
            EXPECT_NEAR(particles.own(field::internal_energy)[i], name == "polytrope_1" ? equilibrium : 0,
                        1e-10 * density);
        }
    }
}

std::string fault_of(const std::string& body, const std::string& rest = gravity) {
    const Communicator comm = world();
    try {
        read(comm, body, rest);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

TEST(DensityProfiles, AreRefusedWhereTheyMakeNoSense) {
    const std::string polytrope = "density_profile = \"polytrope_1\"\n", start = ball;
    EXPECT_EQ(fault_of(start + polytrope), "");
    EXPECT_NE(fault_of(start + polytrope, "").find("needs [gravity] or an internal_energy"),
              std::string::npos);
    EXPECT_EQ(fault_of(start + polytrope + "internal_energy = 1\n", ""), "");
    EXPECT_NE(fault_of(start + polytrope + "inner_radius = 1\n").find("not hollow"), std::string::npos);
    EXPECT_NE(fault_of(start + polytrope + "jitter = 0.1\n").find("even density"), std::string::npos);
    EXPECT_NE(fault_of(start + polytrope + "pressure = 1\n").find("give internal_energy"), std::string::npos);
    EXPECT_NE(fault_of("material = \"gas\"\nshape = \"ellipsoid\"\nsemi_axes = [1, 1, 1]\nspacing = 0.3\n" +
                       polytrope)
                  .find("only a sphere"),
              std::string::npos);
    EXPECT_NE(fault_of("material = \"rock\"\nshape = \"sphere\"\nradius = 1\nspacing = 0.3\n" + polytrope)
                  .find("'rock' is no ideal gas"),
              std::string::npos);
}

}  // namespace
}  // namespace talus::test
