#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "src/run/warnings.hpp"
#include "src/setup/scene_setup.hpp"
#include "tests/support/own_folder.hpp"
#include "tests/support/surfaces.hpp"

/// Scenes as a user writes them: what bodies and impacts they give, and what is said about wrong ones.
namespace talus::test {
namespace {

constexpr const char* run = "[run]\nend_time = 1\n";
constexpr const char* rock = R"([materials.rock]
density = 2700
shear_modulus = "22.7 GPa"
equation_of_state = { kind = "linear", sound_speed = "3 km/s" }
fracture = { weibull_k = 4e35, weibull_m = 9 }
)";
constexpr const char* ice = R"([materials.ice]
density = 920
equation_of_state = { kind = "linear", sound_speed = "3 km/s" }
)";

constexpr const char* two_bodies = R"(
[[body]]
name = "target"
material = "rock"
shape = "sphere"
radius = "50 km"
particles = 500
[[body]]
name = "impactor"
material = "ice"
shape = "sphere"
mass = "1e17 kg"
)";

class SceneFiles : public testing::Test {
  protected:
    void write(const std::string& name, const std::string& text) {
        std::ofstream(folder_.path / name) << text;
    }
    /// The scene of `text` and the materials that it names.
    SceneSetup read(const std::string& text) {
        std::string whole = text + run;
        if (text.find("\"rock\"") != std::string::npos) whole += rock;
        if (text.find("\"ice\"") != std::string::npos) whole += ice;
        return read_scene(comm_, Scene::parse(whole, folder_.path / "s.toml"));
    }
    std::string fault_of(const std::string& text) {
        try {
            read(text);
        } catch (const SceneError& error) {
            return error.what();
        }
        return "accepted";
    }
    void expect_fault(const std::string& text, const std::vector<std::string>& words) {
        const std::string found = fault_of(text);
        for (const std::string& word : words)
            EXPECT_NE(found.find(word), std::string::npos) << "no '" << word << "' in:\n" << found;
        EXPECT_EQ(std::count(found.begin(), found.end(), '\n'), 0) << "more than one fault:\n" << found;
    }

    Communicator comm_{MPI_COMM_SELF};
    OwnFolder folder_;
};

TEST_F(SceneFiles, ImpactorFollowsTheTargetWithEqualMasses) {
    const SceneSetup setup =
        read(std::string(two_bodies) + "[impact]\nspeed = \"300 m/s\"\nangle = \"45 deg\"\n");
    const auto mass_of_a_site = [&](std::size_t b) {
        return setup.bodies[b].density * std::pow(setup.bodies[b].spacing, 3);
    };
    EXPECT_NEAR(mass_of_a_site(1) / mass_of_a_site(0), 1, 1e-12);
    EXPECT_NEAR(setup.census[1].mass / 1e17, 1, 1e-12);  // whatever the number of sites within
    EXPECT_NEAR(volume(setup.bodies[1].shape, 3) * 920, 1e17, 1e5);
    ASSERT_TRUE(setup.impact);
    EXPECT_NEAR(setup.impact->contact.angle, std::numbers::pi / 4, 1e-15);
    const double radius = std::cbrt(1e17 / 920 / (4.0 / 3 * std::numbers::pi));
    EXPECT_NEAR(setup.impact->contact.distance, 50e3 + radius, 1e-6);
    EXPECT_NEAR(norm(setup.impact->start.position),
                50e3 + radius + std::max(setup.bodies[0].spacing, setup.bodies[1].spacing), 1e-6);
    const SceneSetup other =
        read(std::string(two_bodies) + "resolution = \"same_spacing\"\n[impact]\nspeed = 300\n");
    EXPECT_EQ(other.bodies[1].spacing, other.bodies[0].spacing);
}

/// Each side of what tests/stability finds: 55 partners, signs of the pressure, C = 0.5 and 1/eta.
TEST_F(SceneFiles, ChoicesThatFailAreWarnedOf) {
    const std::string body =
        "[[body]]\nmaterial = \"ice\"\nshape = \"sphere\"\nradius = 1\nspacing = 0.2\n[sph]\n";
    const auto warned = [&](const std::string& sph) { return warnings(read(body + sph)); };
    const auto expect = [&](const std::string& sph, const std::string& part) {
        const std::vector<std::string> found = warned(sph);
        ASSERT_EQ(found.size(), 1u) << sph;
        EXPECT_NE(found[0].find(part), std::string::npos) << found[0];
    };
    const std::string spline = "formulation = \"standard\"\nkernel = \"cubic_spline\"\n";
    EXPECT_TRUE(warned(spline + "eta = 1.17\n").empty());                  // 53.7 partners
    expect(spline + "eta = 1.19\n", "with 56 partners (sph.eta = 1.19)");  // 4/3 pi (2 eta)^3
    EXPECT_TRUE(warned("formulation = \"standard\"\nkernel = \"wendland_c2\"\neta = 1.45\n").empty());
    EXPECT_TRUE(warned("interpolation = \"automatic\"\n").empty());
    expect("interpolation = \"cubic\"\n", "sph.interpolation = \"cubic\": compressed matter clumps in 3D");
    expect("interpolation = \"linear\"\n", "sph.interpolation = \"linear\": stretched matter clumps in 3D");
    EXPECT_TRUE(warned("formulation = \"standard\"\ncourant = 0.5\n").empty());
    expect("formulation = \"standard\"\ncourant = 0.51\n", "sph.courant = 0.51");
    EXPECT_TRUE(warned("eta = 0.8\ncourant = 1.25\n").empty());
    expect("eta = 0.8\ncourant = 1.26\n", "blow up above 1.2");
    const auto in_plane = [&](const std::string& sph) {
        return warnings(read("dimension = 2\n" + body + sph));
    };
    EXPECT_TRUE(in_plane("eta = 0.9\n").empty());
    ASSERT_EQ(in_plane("eta = 0.8\n").size(), 1u);
    EXPECT_NE(in_plane("eta = 0.8\n")[0].find("clumps with the cubic interpolation in 2D"),
              std::string::npos);
}

TEST_F(SceneFiles, SpinsAndTheirWarning) {
    const std::string body = "[[body]]\nmaterial = \"ice\"\nshape = \"sphere\"\nradius = 1\nspacing = 0.2\n";
    const SceneSetup slow = read(body + "spin_period = \"6 h\"\nspin_axis = [0, 3, 4]\n"),
                     fast = read(body + "spin_period = \"3 h\"\n");
    EXPECT_NEAR(slow.bodies[0].spin[1], 0.6 * 2 * std::numbers::pi / 21600, 1e-18);
    EXPECT_NEAR(slow.bodies[0].spin[2], 0.8 * 2 * std::numbers::pi / 21600, 1e-18);
    EXPECT_TRUE(warnings(slow).empty());
    ASSERT_EQ(warnings(fast).size(), 1u);  // 920 kg/m3 breaks up at 3.44 h
    EXPECT_NE(warnings(fast)[0].find("from 3.44"), std::string::npos) << warnings(fast)[0];
    expect_fault(body + "spin = [0, 0, 1]\nspin_period = \"3 h\"\n",
                 {"s.toml:7: body[0].spin_period", "not both"});
}

TEST_F(SceneFiles, BodiesOfAnImpactHaveNoPlaceOfTheirOwn) {
    expect_fault(std::string(two_bodies) + "velocity = [1, 0, 0]\n[impact]\nspeed = 300\n",
                 {"s.toml:13: body[1].velocity", "[impact]"});
    expect_fault(std::string(two_bodies) + "centre = [1, 0, 0]\n[impact]\nspeed = 300\n",
                 {"s.toml:13: body[1].centre", "[impact]"});
    expect_fault(std::string(two_bodies) + "[impact]\nspeed = 300\nangle = 0.1\noffset = 3\n",
                 {"impact.offset", "not both"});
    expect_fault(std::string(two_bodies) + "[impact]\nspeed = 300\nimpactor = \"impacter\"\n",
                 {"s.toml:15: impact.impactor", "\"target\", \"impactor\""});
    expect_fault(std::string(two_bodies) + "[impact]\nspeed = 300\noffset = \"100 km\"\n",
                 {"s.toml:15: impact.offset", "pass each other"});
    expect_fault(std::string(two_bodies) + "[impact]\nspeed = 300\nangle = \"91 deg\"\n",
                 {"impact.angle", "too large"});
}

TEST_F(SceneFiles, BodiesThatOverlapOrAreEmpty) {
    expect_fault(std::string(two_bodies) + "centre = [\"60 km\", 0, 0]\n",
                 {"body 'impactor' overlaps body 'target'", "s.toml:8"});
    EXPECT_EQ(fault_of(std::string(two_bodies) + "centre = [\"90 km\", 0, 0]\n"), "accepted");
    expect_fault(
        "[[body]]\nname = \"dust\"\nmaterial = \"ice\"\nshape = \"sphere\"\nradius = 1\nspacing = 10\n",
        {"s.toml:6: body[0].spacing", "body 'dust' has no particles"});
}

TEST_F(SceneFiles, FractureNeedsAMaterialThatCracks) {
    expect_fault(std::string(two_bodies) + "centre = [\"90 km\", 0, 0]\ndamage = 1\n",
                 {"s.toml:14: body[1].damage", "'ice'", "[fracture]"});
}

TEST_F(SceneFiles, StrengthAndFractureNeedASolid) {
    const std::string body = "[[body]]\nmaterial = \"mud\"\nshape = \"sphere\"\nradius = 1\nspacing = 0.2\n";
    const std::string mud =
        "[materials.mud]\ndensity = 2000\nequation_of_state = { kind = \"linear\", sound_speed = 1e3 }\n";
    EXPECT_EQ(fault_of(body + mud), "accepted");
    expect_fault(body + mud + "fracture = { weibull_k = 1e30, weibull_m = 9 }\n",
                 {"s.toml:9: materials.mud.fracture", "shear_modulus"});
    expect_fault(body + mud + "strength = { kind = \"von_mises\", yield_stress = 1e6 }\n",
                 {"s.toml:9: materials.mud.strength", "shear_modulus"});
}

TEST_F(SceneFiles, ShapeFiles) {
    const Polyhedron ball = icosphere(3);
    write("ball.obj", obj_text(ball));
    const std::string body =
        "[[body]]\nmaterial = \"rock\"\nshape = \"mesh\"\nfile = \"ball.obj\"\nparticles = 2000\n";
    const double unit_volume = integrate(ball).volume;
    const auto volume_of = [&](const std::string& more) {
        return volume(read(body + more).bodies[0].shape, 3);
    };
    EXPECT_NEAR(volume_of("") / (1e9 * unit_volume), 1, 1e-12) << "shape files are in km";
    EXPECT_NEAR(volume_of("file_unit = \"2 m\"\n") / (8 * unit_volume), 1, 1e-12);
    EXPECT_NEAR(volume_of("mean_radius = \"3 m\"\n") / (36 * std::numbers::pi), 1, 1e-12);
    EXPECT_NEAR(volume_of("mass = \"5.4 Mg\"\n"), 2, 1e-12);
    const SceneSetup setup =
        read(body + "centre = [10, 20, 30]\norientation = [\"10 deg\", 0, \"20 deg\"]\n");
    EXPECT_NEAR(static_cast<double>(setup.census[0].count) / 2000, 1, 0.02);
    EXPECT_NEAR(centre(setup.bodies[0].shape)[2], 30, 1e-12);
    // What lies in the shape by its lattice is what a sphere would hold, but for the lattice's surface.
    EXPECT_NEAR(setup.census[0].mass / (2700 * 1e9 * unit_volume), 1, 0.02);

    Polyhedron open = ball;
    open.triangles.pop_back();
    write("open.obj", obj_text(open));
    const std::string of_open = "[[body]]\nmaterial = \"rock\"\nshape = \"mesh\"\nparticles = 100\nfile = ";
    expect_fault(of_open + "\"open.obj\"\n",
                 {"s.toml:5: body[0].file", "open.obj", "3 of 1920 edges are open"});
    expect_fault(of_open + "\"none.obj\"\n", {"s.toml:5: body[0].file", "none.obj"});
    expect_fault(
        "[[body]]\nmaterial = \"none\"\nshape = \"mesh\"\nfile = \"ball.obj\"\nmass = 1\nparticles = 9\n",
        {"s.toml:2: body[0].material"});
    expect_fault(body + "mass = 1\nmean_radius = 1\n", {"body[0].mass", "not both"});
}

TEST_F(SceneFiles, BodiesThatCannotSettleForAFaultOfTheirs) {
    std::string text = two_bodies;
    text.replace(text.find("radius = \"50 km\""), 16, "radius = \"-50 km\"");
    expect_fault(text + "[impact]\nspeed = 300\n[gravity]\n[settle]\nlongest = \"1 s\"\n",
                 {"radius", "-50 km"});
}

TEST_F(SceneFiles, GlassNeedsAnOpenBox) {
    const std::string body =
        "[[body]]\nmaterial = \"ice\"\nshape = \"sphere\"\nradius = 1\nspacing = 0.2\n"
        "lattice = \"glass\"\n";
    EXPECT_EQ(fault_of(body), "accepted");
    expect_fault("dimension = 1\n" + body, {"body[0].lattice", "one dimension"});
    expect_fault(body +
                     "[box]\nboundaries = [\"periodic\", \"open\", \"open\"]\nlower = [-2, -2, -2]\n"
                     "upper = [2, 2, 2]\n",
                 {"body[0].lattice", "closed boundaries"});
}

}  // namespace
}  // namespace talus::test
