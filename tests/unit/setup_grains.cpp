#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "domain/clump_fields.hpp"
#include "domain/grain_fields.hpp"
#include "src/setup/grain_scene.hpp"
#include "src/setup/hard_impacts.hpp"
#include "tests/support/own_folder.hpp"

/// Scenes of grains as a user writes them: what they give, and what is said about wrong ones.
namespace talus::test {
namespace {

constexpr const char* scene_text = R"([box]
boundaries = ["periodic", "periodic", "open"]
lower = [0, 0, 0]
upper = [0.1, 0.1, 1]
[materials.glass]
density = 2500
youngs_modulus = 1e8
poisson_ratio = 0.3
restitution = 0.6
friction = 0.5
[dem]
gravity = [0, 0, -9.81]
time_step = 3e-6
[[grains]]
material = "glass"
radius = 0.001
shape = "box"
lower = [0, 0, 0.01]
upper = [0.05, 0.05, 0.05]
spacing = 0.005
[[wall]]
name = "floor"
material = "glass"
point = [0, 0, 0]
normal = [0, 0, 2]
[run]
end_time = 1
)";

const std::string source_text =
    "[[source]]\nname = \"rain\"\nmaterial = \"glass\"\nradii = [0.002, 0.003]\nshape = \"domain\"\nrate = "
    "100\n";

std::string replaced(const std::string& from, const std::string& to) {
    std::string text = scene_text;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

GrainScene read(const std::string& text) {
    const Communicator comm(MPI_COMM_SELF);
    return read_grain_scene(comm, Scene::parse(text, "s.toml"));
}

std::string fault_of(const std::string& text) {
    try {
        read(text);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "no fault";
}

void expect_fault(const std::string& from, const std::string& to, const std::string& fault) {
    const std::string found = fault_of(replaced(from, to));
    EXPECT_NE(found.find(fault), std::string::npos) << found;
}

TEST(SetupGrains, ReadsAScene) {
    const Communicator comm(MPI_COMM_SELF);
    const GrainScene scene = read(scene_text);
    const ParticleSet grains = make_grains(comm, scene);
    EXPECT_EQ(grains.size(), 10U * 10 * 8);
    EXPECT_NEAR(grains.data(field::mass)[7], 2500 * 4.18879020478639e-9, 1e-18);
    ASSERT_EQ(scene.simulation.walls.size(), 1U);
    EXPECT_EQ(std::get<dem::PlaneShape>(scene.simulation.walls[0].shape).normal.z, 1);
    // 0.3 pi r sqrt(rho/G) / (0.1631 nu + 0.8766), G = E / (2 (1 + nu))
    EXPECT_NEAR(scene.greatest_time_step, 0.3 * 2.7366e-5, 1e-9);
}

TEST(SetupGrains, RefusesWhatCannotBe) {
    expect_fault("restitution = 0.6", "restitution = 1.5", "s.toml:9: materials.glass.restitution = 1.5");
    expect_fault("youngs_modulus = 1e8", "youngs_modulus = 0",
                 "s.toml:7: materials.glass.youngs_modulus = 0");
    expect_fault("time_step = 3e-6", "time_step = 3e-5", "s.toml:13: dem.time_step");
    expect_fault("time_step = 3e-6", "time_step = 3e-5",
                 "0.3 of the time in which a Rayleigh wave crosses a grain of 0.001 m");
    expect_fault("gravity =", "law = \"linear\"\nstiffness = 0\ngravity =", "dem.stiffness = 0");
    expect_fault("normal = [0, 0, 2]", "normal = [0, 1, 2]", "must be 0 along y, where the box is periodic");
    expect_fault("upper = [0.1, 0.1, 1]", "upper = [0.1, 0.004, 1]", "two diameters of the largest grain");
    expect_fault("\"periodic\", \"open\"", "\"reflecting\", \"open\"",
                 "grains know open and periodic boundaries");
    expect_fault("[[wall]]\nname = \"floor\"\nmaterial = \"glass\"",
                 "[[wall]]\nname = \"floor\"\nmaterial = \"glas\"", "there is no table [materials.glas]");
    expect_fault("radius = 0.001", "radius = 0.001\nrolling_friction = 1", "rolling_friction");
    expect_fault("gravity =", "adhesion = \"jkr\"\nend_of_contact = \"cut_at_zero\"\ngravity =",
                 "needs end_of_contact = \"may_attract\"");
    expect_fault("gravity =", "adhesion = \"jkr\"\nlaw = \"linear\"\nstiffness = 1e5\ngravity =",
                 "it needs law = \"hertz\"");
    expect_fault("gravity =", "adhesion = \"jkr\"\ngravity =", "materials.glass.work_of_adhesion (missing");
    expect_fault("gravity =", "adhesion = \"van_der_waals\"\ngravity =", "dem.separation (missing");
    expect_fault(
        "gravity =", "adhesion = \"dmt\"\nfilm = \"viscous\"\ngravity =", "does not go with adhesion");
    expect_fault(
        "gravity =", "film = \"viscous\"\nviscosity = 1\nroughness = 1e-5\nfilm_reach = 1e-6\ngravity =",
        "must be above the roughness");
    expect_fault(
        "gravity =", "film = \"viscous\"\nviscosity = 10\nroughness = 1e-5\nfilm_reach = 1e-4\ngravity =",
        "the limit of the film between a grain of 0.001 m");
    expect_fault("friction = 0.5", "friction = 0.5\ntwisting_friction = 0.5", "twisting_friction");
    expect_fault("[[wall]]", "[[contact]]\nmaterials = [\"glass\", \"steel\"]\n[[wall]]",
                 "no grains and no wall are of 'steel'");
    expect_fault("friction = 0.5",
                 "friction = 0.5\n[[contact]]\nmaterials = [\"glass\", \"glass\"]\nrestitution = 1.2",
                 "contact[0].restitution = 1.2");
}

TEST(SetupGrains, RefusesWhatDoesNotGoTogether) {
    const std::string bond = "[[bond]]\ngrains = [\"g\"]\nyoungs_modulus = 1e6\npoisson_ratio = 0.2\n",
                      region = "[[region]]\nname = \"all\"\nshape = \"domain\"\n";
    const auto expect = [](const std::string& more, const std::string& fault) {
        std::string text = replaced("[[grains]]", "[[grains]]\nname = \"g\"");
        text.insert(text.find("[[wall]]"), more);
        const std::string found = fault_of(text);
        EXPECT_NE(found.find(fault), std::string::npos) << found;
    };
    expect(bond, "no fault");
    expect(bond + region, "region[0].stress");
    expect(bond + region + "stress = false\n", "no fault");
    expect(bond + "[settle]\nlongest = 1\n", "(knows contacts only, and the scene has bonds)");
    expect(bond + "[output]\ncontacts = true\n", "output.contacts");
    expect("[[wall]]\nname = \"floor\"\nmaterial = \"glass\"\npoint = [0, 0, 1]\nnormal = [0, 0, -1]\n",
           "there is another of the name 'floor'");
}

TEST(SetupGrains, SourcesInsertClumps) {
    const std::string table =
        "[clumps.pair]\nx = [\"-1 mm\", \"1 mm\"]\ny = [0, 0]\nz = [0, 0]\nradii = [0.002, 0.001]\n";
    const auto with = [&](const std::string& keys) {
        std::string text = source_text;
        return scene_text + text.replace(text.find("radii = [0.002, 0.003]"), 22, keys) + table;
    };
    const GrainScene scene = read(with("clump = \"pair\""));
    const GrainSource& source = scene.simulation.flow.sources.at(0);
    EXPECT_EQ(source.greatest_radius(), 0.002);
    EXPECT_TRUE(source.turned);
    EXPECT_EQ(scene.simulation.clumps.at(source.body).shape, source.clump);
    EXPECT_EQ(scene.simulation.clumps.at(0).shape, nullptr);
    EXPECT_FALSE(read(with("clump = \"pair\"\norientation = \"aligned\"")).bodies.at(1).turned);
    EXPECT_NE(fault_of(with("clump = \"trio\"")).find("source[0].clump"), std::string::npos);
    EXPECT_NE(fault_of(with("clump = \"pair\"\nradius = 0.001")).find("source[0].radius"), std::string::npos);
    std::string shrinks = with("clump = \"pair\"");
    shrinks.replace(shrinks.find("[dem]"), 5, "[dem]\noverlaps = \"shrink\"");
    EXPECT_NE(fault_of(shrinks).find("dem.overlaps"), std::string::npos) << fault_of(shrinks);
}

// Eight places, two spheres at each: 1 mm apart, of 1 mm radius.
TEST(SetupGrains, ClumpsStandAtThePlacesOfAPacking) {
    const std::string table =
        "[clumps.pair]\nx = [\"-0.5 mm\", \"0.5 mm\"]\ny = [0, 0]\nz = [0, 0]\nradii = [0.001, 0.001]\n";
    const auto with = [&](const std::string& key, const std::string& clumps) {
        return replaced("radius = 0.001", key) + clumps;
    };
    const Communicator comm(MPI_COMM_SELF);
    for (const bool turned : {false, true}) {
        const GrainScene scene =
            read(with(turned ? "clump = \"pair\"" : "clump = \"pair\"\norientation = \"aligned\"", table));
        const ParticleSet grains = make_grains(comm, scene);
        ASSERT_EQ(grains.size(), 2U * 10 * 10 * 8);
        const double* x = grains.data(field::position, 0);
        EXPECT_EQ(std::abs(x[1] - x[0] - 0.001) < 1e-12, !turned);
        const dem::ClumpBody& clump = scene.simulation.clumps.at(0);
        // Two balls less the lens that they share, 5 pi/12 r^3.
        EXPECT_NEAR(clump.mass(), 2500 * (8.0 / 3 - 5.0 / 12) * M_PI * 1e-9, 1e-4 * clump.mass());
        EXPECT_EQ(grains.data(field::mass)[5], clump.mass());
    }
    EXPECT_NE(fault_of(with("clump = \"trio\"", table)).find("there is no table [clumps.trio]"),
              std::string::npos);
    EXPECT_NE(fault_of(with("clump = \"pair\"", "[clumps.pair]\nx = [0]\ny = [0]\nz = [0]\nradii = [0]\n"))
                  .find("lengths above 0"),
              std::string::npos);
    EXPECT_NE(fault_of(with("clump = \"pair\"", "[clumps.pair]\nx = [0]\ny = [0]\nz = [0]\nradii = [1, 1]\n"))
                  .find("clumps.pair.x"),
              std::string::npos);
}

// Walls that differ along a periodic axis would be missed by the images of grains.
TEST(SetupGrains, OnlyPlanesThatDoNotTurnStandInPeriodicBoxes) {
    expect_fault(
        "normal = [0, 0, 2]",
        "normal = [0, 0, 2]\n[wall.motion]\nangular_velocity = 1\ncentre = [0, 0, 0]\naxis = [0, 0, 1]",
        "a wall that turns needs a box that is open along all axes");
    expect_fault("point = [0, 0, 0]\nnormal = [0, 0, 2]",
                 "kind = \"container\"\nlower = [0, 0, 0]\nupper = [1, 1, 1]",
                 "'container' needs a box that is open along all axes (allowed here: plane)");
}

std::string sheared_scene(const std::string& box, const std::string& keys_of_grains) {
    std::string text = scene_text;
    const std::size_t wall = text.find("[[wall]]"), run = text.find("[run]");
    text = text.substr(0, wall) + text.substr(run);
    text.replace(text.find("\"open\"]"), 6, "\"periodic\"");
    text.replace(text.find("upper"), 5, box + "upper");
    return text.replace(text.find("radius"), 6, keys_of_grains + "radius");
}

TEST(ShearedScenes, AddTheShearFlowToTheVelocitiesAtTheStart) {
    const Communicator comm(MPI_COMM_SELF);
    const GrainScene scene = read(sheared_scene("shear_rate = 20\n", "velocity = [1, 0, 0]\n"));
    EXPECT_EQ(scene.simulation.box.shear_rate, 20);
    const ParticleSet grains = make_grains(comm, scene);
    ASSERT_GT(grains.size(), 0U);
    for (std::size_t i = 0; i < grains.size(); ++i)
        EXPECT_NEAR(grains.data(field::velocity, 0)[i], 1 + 20 * (grains.data(field::position, 1)[i] - 0.05),
                    1e-12);
}

TEST(ShearedScenes, WrongOnesAreRefused) {
    const auto expect = [](const std::string& text, const std::string& fault) {
        const std::string found = fault_of(text);
        EXPECT_NE(found.find("box.shear_rate"), std::string::npos) << found;
        EXPECT_NE(found.find(fault), std::string::npos) << found;
    };
    expect(sheared_scene("shear_rate = 20\n", "held = true\n"), "holds no grains that are held");
    expect(replaced("lower = [0, 0, 0]\nupper", "shear_rate = 20\nlower = [0, 0, 0]\nupper"),
           "periodic along all axes");
    expect(replaced("lower = [0, 0, 0]\nupper", "shear_rate = 20\nlower = [0, 0, 0]\nupper"),
           "holds no walls");
    expect(sheared_scene("shear_rate = \"20 m\"\n", ""), "s-1");
}

ImpactFindings impacts_of(const std::string& time_step, const std::string& keys_of_grains,
                          const std::string& more = "") {
    const Communicator comm(MPI_COMM_SELF);
    std::string text = scene_text;
    text.replace(text.find("3e-6"), 4, time_step);
    text.insert(text.find("radius"), keys_of_grains);
    text.insert(text.find("[[wall]]"), more);
    const GrainScene scene = read(text);
    return find_hard_impacts(comm, scene, make_grains(comm, scene));
}

// The Rayleigh time of these grains is 27 us, 0.3 of it 8.2 us. A collision with the floor lasts 2.94 d/v
// (Hertz): 44.6 us at 40 m/s, 5.57 steps of 8 us, and 61.5 us at 8 m/s, 7.7 steps of 8 us or 20.5 of 3 us.
TEST(SetupGrains, CollisionsOfTooFewStepsAreWarnedOfAndRefused) {
    const ImpactFindings fast = impacts_of("8e-6", "velocity = [0, 0, -40]\n"),
                         slow = impacts_of("8e-6", "velocity = [0, 0, -8]\n"),
                         fine = impacts_of("3e-6", "velocity = [0, 0, -8]\n");
    ASSERT_EQ(fast.faults.size(), 1U);
    EXPECT_NE(fast.faults[0].find("'floor' at 40 m/s lasts 5.57"), std::string::npos) << fast.faults[0];
    EXPECT_NE(fast.faults[0].find("allowed: at most 7.43e-06 s"), std::string::npos) << fast.faults[0];
    EXPECT_TRUE(slow.faults.empty());
    ASSERT_EQ(slow.warnings.size(), 1U);
    EXPECT_NE(slow.warnings[0].find("dem.time_step ="), std::string::npos) << slow.warnings[0];
    EXPECT_TRUE(fine.faults.empty() && fine.warnings.empty());
}

// Springs of 1 kN/m under grains of 10 mg, restitution 0.6: with c = 40 gamma_t/m of the closest packing and
// k_t = 2/7 k_n 4 = (80 k_t/m) dt^2 + 4 c dt at 17 us, of undamped springs at 43 us; above 37 us they are
// refused.
TEST(SetupGrains, StepsThatTheClosestPackingDoesNotBearAreWarnedOf) {
    const auto warned = [](const std::string& time_step) {
        std::string text = replaced("gravity =", "law = \"linear\"\nstiffness = 1000\ngravity =");
        const std::string of_hertz = "youngs_modulus = 1e8\npoisson_ratio = 0.3\n";
        text.replace(text.find(of_hertz), of_hertz.size(), "");
        text.replace(text.find("3e-6"), 4, time_step);
        const std::vector<std::string> warnings = read(text).warnings;
        return std::ranges::any_of(warnings, [](const std::string& w) {
            return w.find("the densest packing") != std::string::npos;
        });
    };
    EXPECT_TRUE(warned("1.8e-5"));
    EXPECT_TRUE(warned("3.5e-5"));
    EXPECT_FALSE(warned("1.6e-5"));
}

// A ball ten times as large presses the grains that it catches: they bear 7.6 us, less than their Rayleigh
// time allows.
TEST(SetupGrains, GrainsCaughtUnderAHeavyBallAreWarnedOf) {
    const std::string ball =
        "[[grains]]\nname = \"ball\"\nmaterial = \"glass\"\nradius = 0.01\nspacing = 0.02\nshape = \"box\"\n"
        "lower = [0.02, 0.02, 0.07]\nupper = [0.04, 0.04, 0.09]\nvelocity = [0, 0, -5]\n";
    const auto warns = [&](const std::string& time_step) {
        for (const std::string& warning : impacts_of(time_step, "", ball).warnings)
            if (warning.find("caught under one of 'ball'") != std::string::npos) return true;
        return false;
    };
    EXPECT_TRUE(warns("8e-6"));
    EXPECT_FALSE(warns("7e-6"));
}

TEST(ShearedScenes, HoldClumps) {
    const Communicator comm(MPI_COMM_SELF);
    std::string text = sheared_scene("shear_rate = 20\n", "");
    text.replace(text.find("radius = 0.001"), 14, "clump = \"pair\"");
    const GrainScene scene =
        read(text + "[clumps.pair]\nx = [0, 0.001]\ny = [0, 0]\nz = [0, 0]\nradii = [0.001, 0.001]\n");
    const ParticleSet grains = make_grains(comm, scene);
    ASSERT_GT(grains.size(), 0U);
    for (std::size_t i = 0; i < grains.size(); ++i)
        EXPECT_NEAR(grains.data(field::clump_velocity, 0)[i],
                    20 * (grains.data(field::clump_centre, 1)[i] - 0.05), 1e-12);
}

TEST(SetupGrains, SourcesAreBodiesOfTheirOwn) {
    std::string text = scene_text;
    text.insert(text.find("[[wall]]"), source_text +
                                           "[[sink]]\nshape = \"plane\"\npoint = [0, 0, 0.01]\n"
                                           "normal = [0, 0, 1]\n[[region]]\nname = \"all\"\n"
                                           "shape = \"domain\"\n");
    const Communicator comm(MPI_COMM_SELF);
    const GrainScene scene = read(text);
    ASSERT_EQ(scene.bodies.size(), 2U);
    EXPECT_EQ(scene.simulation.material.size(), 2U);
    EXPECT_EQ(make_grains(comm, scene).size(), 10U * 10 * 8) << "none of the source at the start";
    const GrainFlowPlan& flow = scene.simulation.flow;
    ASSERT_EQ(flow.sources.size(), 1U);
    EXPECT_EQ(flow.sources[0].body, 1);
    EXPECT_EQ(flow.sources[0].sizes.greatest, 0.003);
    EXPECT_FALSE(flow.sources[0].by_mass);
    EXPECT_EQ(scene.simulation.skin, 0.3 * 0.001) << "for the smallest";
    ASSERT_EQ(flow.sinks.size(), 1U);
    EXPECT_EQ(flow.sinks[0].interval, 100U);
    EXPECT_TRUE(flow.sinks[0].region.contains({0, 0, 0.009}));
    EXPECT_FALSE(flow.sinks[0].region.contains({0, 0, 0.011}));
    ASSERT_EQ(scene.regions.size(), 1U);
}

TEST(SetupGrains, RefusesSourcesAndSinksThatCannotBe) {
    const auto expect_source_fault = [](const std::string& more, const std::string& fault) {
        expect_fault("[[wall]]", source_text + more + "\n[[wall]]", fault);
    };
    expect_source_fault("mass_rate = 1", "give rate or mass_rate, not both");
    expect_source_fault("total_mass = 1", "rate goes with number, mass_rate with total_mass");
    expect_source_fault("interval = 0", "source[0].interval = 0");
    expect_source_fault("tries = 0", "source[0].tries = 0");
    expect_source_fault("begin = 2\nend = 1", "must not be before begin");
    expect_source_fault("held = true", "source[0].held");
    expect_source_fault(source_text, "there is another of the name 'rain'");
    expect_source_fault("begin = -1\n[settle]\nlongest = 2", "must say how much it inserts in all");
    expect_fault("[[wall]]", "[settle]\nlongest = 1e-9\n[[wall]]", "is shorter than two looks");
    expect_fault("normal = [0, 0, 2]",
                 "normal = [0, 0, 2]\n[wall.motion]\nvelocity = [0, 0, 1]\nbegin = -1\n[settle]\nlongest = 2",
                 "must not be before time 0, while grains settle");
    const std::string sink = "[[sink]]\nshape = \"plane\"\npoint = [0, 0, 0]\n";
    expect_fault("[[wall]]", sink + "normal = [0, 0, 0]\n[[wall]]", "must have a length above 0");
    expect_fault("[[wall]]", sink + "normal = [1, 0, 0]\n[[wall]]",
                 "must be 0 along x, where the box is periodic");
    expect_fault("[[wall]]", "[[sink]]\nshape = \"cylinder\"\n[[wall]]", "sink[0].shape");
}

/// A tetrahedron of 1 mm as an OBJ file; `faces` of it.
std::string tetrahedron(int faces) {
    const char* const lines[] = {"f 1 3 2\n", "f 1 2 4\n", "f 2 3 4\n", "f 3 1 4\n"};
    std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
    for (int k = 0; k < faces; ++k) text += lines[k];
    return text;
}

class MeshWalls : public testing::Test {
  protected:
    /// The scene in an open box, with this wall in place of the plane.
    GrainScene read_with(const std::string& wall) const {
        std::string text = scene_text;
        const auto put = [&](const std::string& from, const std::string& to) {
            text.replace(text.find(from), from.size(), to);
        };
        put("\"periodic\", \"periodic\", \"open\"", "\"open\", \"open\", \"open\"");
        put("point = [0, 0, 0]\nnormal = [0, 0, 2]", wall);
        const Communicator comm(MPI_COMM_SELF);
        return read_grain_scene(comm, Scene::parse(text, folder_.path / "s.toml"));
    }
    void write(const std::string& name, const std::string& content) const {
        std::ofstream(folder_.path / name) << content;
    }
    std::string fault_with(const std::string& wall) const {
        try {
            read_with(wall);
        } catch (const SceneError& error) {
            return error.what();
        }
        return "no fault";
    }

    OwnFolder folder_;
};

TEST_F(MeshWalls, AreReadInTheirUnitWithWarnings) {
    write("closed.obj", tetrahedron(4));
    const GrainScene closed = read_with("kind = \"mesh\"\nfile = \"closed.obj\"\nfile_unit = \"1 mm\"");
    const auto& sheet =
        std::get<std::shared_ptr<const dem::TriangleSurface>>(closed.simulation.walls.at(0).shape);
    EXPECT_EQ(sheet->mesh().triangles.size(), 4U);
    EXPECT_DOUBLE_EQ(sheet->upper().x, 0.001);
    EXPECT_TRUE(closed.warnings.empty());

    write("open.obj", tetrahedron(3));
    const GrainScene open = read_with("kind = \"mesh\"\nfile = \"open.obj\"");
    ASSERT_EQ(open.warnings.size(), 1U);
    EXPECT_NE(open.warnings[0].find("wall 'floor': "), std::string::npos) << open.warnings[0];
    EXPECT_NE(open.warnings[0].find("3 edges belong to one triangle only"), std::string::npos)
        << open.warnings[0];
}

TEST_F(MeshWalls, FaultsNameTheFile) {
    const auto expect = [&](const std::string& wall, const std::string& fault) {
        const std::string found = fault_with(wall);
        EXPECT_NE(found.find(fault), std::string::npos) << found;
    };
    expect("kind = \"mesh\"", "wall[0].file");
    expect("kind = \"mesh\"\nfile = \"none.obj\"", "none.obj");
    write("empty.obj", "v 0 0 0\n");
    expect("kind = \"mesh\"\nfile = \"empty.obj\"", "empty.obj");
    write("closed.obj", tetrahedron(4));
    expect("kind = \"mesh\"\nfile = \"closed.obj\"\nfile_unit = 0", "wall[0].file_unit = 0");
}

/// What many draws of a distribution give.
struct Drawn {
    double least = 1e300, greatest = 0;
    double volume_below = 0;  ///< share of the volume of radii up to `at`
    double number_below = 0;  ///< the same of the grains
};

Drawn drawn(const std::string& keys, double at) {
    std::string text = replaced("radius = 0.001", keys);
    text.replace(text.find("3e-6"), 4, "1e-9");
    const GrainSizes sizes = read(text).bodies[0].sizes;
    const RandomStream random{7, RandomPurpose::positions, 0};
    Drawn found;
    double volume = 0;
    constexpr std::uint64_t draws = 100000;
    for (std::uint64_t id = 0; id < draws; ++id) {
        const double r = sizes.radius(random, id, 3), r3 = r * r * r;
        found.least = std::min(found.least, r);
        found.greatest = std::max(found.greatest, r);
        found.volume_below += r <= at ? r3 : 0;
        found.number_below += r <= at ? 1.0 / draws : 0;
        volume += r3;
    }
    found.volume_below /= volume;
    return found;
}

// Closed forms; 1e5 draws scatter by 1/sqrt(1e5) = 0.003, volume by more: 2.5 of that are allowed, 5 of
// volume.
TEST(SetupGrains, SizesAreDistributedAsAskedFor) {
    Drawn found = drawn("radii = [0.0005, 0.0015]", 0.001);
    EXPECT_NEAR(found.number_below, 0.5, 0.008);
    found = drawn("radii = [0.0001, 0.002]\ndistribution = \"volume_uniform\"", 0.00105);
    EXPECT_NEAR(found.volume_below, 0.5, 0.015);
    EXPECT_GE(found.least, 0.0001);
    EXPECT_LE(found.greatest, 0.002);
    EXPECT_GT(found.greatest, 0.0019);
    const std::string lognormal = "distribution = \"lognormal\"\nmedian = 0.001\ndeviation = 0.5";
    found = drawn("radii = [1e-6, 0.0021]\n" + lognormal, 0.001);
    // 0.5 of what is left below ln(2.1)/0.5 = 1.4839 standard deviations, which is 0.93108.
    EXPECT_NEAR(found.number_below, 0.5 / 0.93108, 0.008);
    EXPECT_LE(found.greatest, 0.0021);
    found =
        drawn("radii = [0.0005, 0.001, 0.002]\ndistribution = \"table\"\nvolume_shares = [1, 1, 2]", 0.001);
    EXPECT_NEAR(found.volume_below, 0.5, 0.015);
    EXPECT_NEAR(found.number_below, 1 - 0.25 / (8 + 1 + 0.25), 0.008);
}

TEST(SetupGrains, RefusesSizesThatCannotBe) {
    expect_fault("radius = 0.001", "radii = [0.002, 0.001]",
                 "grains[0].radii = [0.002, 0.001] (must be two radii above 0 in order)");
    expect_fault("radius = 0.001", "radii = [0.001, 0.002]\ndistribution = \"normal\"", "distribution");
    expect_fault("radius = 0.001",
                 "radii = [0.01, 0.02]\ndistribution = \"lognormal\"\nmedian = 0.001\ndeviation = 0.2",
                 "less than a hundredth");
    expect_fault("radius = 0.001", "radii = [0.001, 0.002]\ndistribution = \"table\"\nvolume_shares = [1]",
                 "as many as radii");
}

}  // namespace
}  // namespace talus::test
