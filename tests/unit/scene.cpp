#include "io/scene.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "io/spelling.hpp"
#include "tests/support/own_folder.hpp"

namespace talus {
namespace {

Scene scene_of(std::string text, bool quick = false, const std::vector<std::string>& overrides = {}) {
    return Scene::parse(std::move(text), "s.toml", quick, overrides);
}

std::string faults(const Scene& scene) {
    try {
        scene.finish();
    } catch (const SceneError& failure) {
        return failure.what();
    }
    return "";
}

std::string parse_failure(const std::string& text, const std::vector<std::string>& overrides = {}) {
    try {
        scene_of(text, false, overrides);
    } catch (const SceneError& failure) {
        return failure.what();
    }
    return "";
}

TEST(Scene, ReadsValues) {
    const Scene scene = scene_of(R"(
title = "a \"rock\""
[run]
end_time = "2 ms"
steps = 1e3
verbose = true
kind = "solid"
center = [1, "2 cm", 3.5]
files = ["a", "b"]
[[body]]
radius = 0.03
[[body]]
radius = "7 mm"
[body.shape]
kind = "sphere"
)");
    const Section run = scene.root().section("run");
    EXPECT_EQ(scene.root().text("title"), "a \"rock\"");
    EXPECT_DOUBLE_EQ(run.number("end_time", "s"), 2e-3);
    EXPECT_EQ(run.integer("steps"), 1000);
    EXPECT_TRUE(run.flag("verbose"));
    EXPECT_EQ(run.choice("kind", {"gas", "solid"}), "solid");
    EXPECT_EQ(run.numbers("center", "m", 3), (std::vector<double>{1, 0.02, 3.5}));
    EXPECT_EQ(run.texts("files", 0), (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(run.number("courant", "1", 0.25), 0.25);
    EXPECT_FALSE(run.has("courant"));
    const auto bodies = scene.root().sections("body");
    ASSERT_EQ(bodies.size(), 2U);
    EXPECT_EQ(bodies[1].path(), "body[1]");
    EXPECT_EQ(bodies[0].number("radius", "m"), 0.03);
    EXPECT_DOUBLE_EQ(bodies[1].number("radius", "m"), 7e-3);
    EXPECT_EQ(bodies[1].section("shape").text("kind"), "sphere");
    EXPECT_FALSE(scene.root().section("gravity").exists());
    EXPECT_EQ(faults(scene), "");
}

TEST(Scene, ReportsEverythingAtOnceInOrderOfLine) {
    const Scene scene = scene_of(R"([run]
end_tme = 3
courant = 2.0
steps = 2.5
[[body]]
radius = "3 kg"
material = "basalt"
[[body]]
radius = -1
kind = "sphre"
center = [0, 0]
verbose = 1
[bodi]
x = 1
)");
    const Section run = scene.root().section("run");
    for (const Section& body : scene.root().sections("body")) {
        body.number("radius", "m", {}, {.min = 0, .min_excluded = true});
        body.text("material");
        body.choice("kind", {"sphere", "box"}, "sphere");
        body.numbers("center", "m", 3, std::vector<double>{0, 0, 0});
        body.flag("verbose", false);
    }
    run.number("end_time", "s");
    run.number("courant", "1", 0.3, {.min = 0, .max = 1});
    run.integer("steps", 1, 0);
    run.error("courant", "unstable with this kernel");
    EXPECT_EQ(faults(scene),
              "s.toml:1: run.end_time (missing; allowed: a number in s, or text with a unit)\n"
              "s.toml:2: run.end_tme = 3 (unknown key; did you mean run.end_time?)\n"
              "s.toml:3: run.courant = 2 (too large; allowed: at least 0 and at most 1)\n"
              "s.toml:3: run.courant = 2 (unstable with this kernel)\n"
              "s.toml:4: run.steps = 2.5 (not a whole number)\n"
              "s.toml:6: body[0].radius = \"3 kg\" ('3 kg' is a mass; expected: length [m])\n"
              "s.toml:8: body[1].material (missing; allowed: a text)\n"
              "s.toml:9: body[1].radius = -1 (too small; allowed: more than 0 m)\n"
              "s.toml:10: body[1].kind = \"sphre\" (not a choice; did you mean \"sphere\"?; allowed: "
              "\"sphere\", \"box\")\n"
              "s.toml:11: body[1].center = [0, 0] (wrong count; allowed: [3 of a number in m, or text with a "
              "unit])\n"
              "s.toml:12: body[1].verbose = 1 (not a truth value; allowed: true, false)\n"
              "s.toml:13: bodi = a table (unknown key; did you mean body?)");
}

TEST(Scene, SyntaxErrorsNameLineAndColumn) {
    EXPECT_TRUE(parse_failure("a = 1\nb = \n").starts_with("s.toml:2:")) << parse_failure("a = 1\nb = \n");
    const std::string duplicate = parse_failure("x = 1\nx = 2\n");
    EXPECT_TRUE(duplicate.starts_with("s.toml:2:")) << duplicate;
    EXPECT_NE(duplicate.find("redefine"), std::string::npos) << duplicate;
    EXPECT_TRUE(parse_failure("d = 2020-01-01\n").starts_with("s.toml:1: dates"));
    EXPECT_TRUE(parse_failure("quick = 1\n").starts_with("s.toml:1: quick = 1 (not a table"));
}

TEST(Scene, MissingFileIsNamed) {
    try {
        Scene::read("/nowhere/s.toml");
        FAIL();
    } catch (const SceneError& failure) {
        EXPECT_STREQ(failure.what(), "/nowhere/s.toml: no such file");
    }
}

TEST(Scene, FolderMeansItsSceneFile) {
    const test::OwnFolder folder;
    std::ofstream(folder.path / "scene.toml") << "a = 3\n";
    const Scene scene = Scene::read(folder.path);
    EXPECT_EQ(scene.root().integer("a"), 3);
    EXPECT_EQ(scene.file(), folder.path / "scene.toml");
    EXPECT_EQ(scene.text(), "a = 3\n");
}

const std::string with_quick = R"([run]
end_time = 3
[[body]]
spacing = 1
[quick]
run.end_time = 0.5
[[quick.body]]
spacing = 2
)";

TEST(Scene, QuickOverridesOnlyQuickRuns) {
    for (const bool quick : {false, true}) {
        const Scene scene = scene_of(with_quick, quick);
        EXPECT_EQ(scene.root().section("run").number("end_time", "s"), quick ? 0.5 : 3);
        EXPECT_EQ(scene.root().sections("body").at(0).number("spacing", "m"), quick ? 2 : 1);
        EXPECT_EQ(faults(scene), "");
    }
}

TEST(Scene, QuickIsCheckedInOrdinaryRuns) {
    const Scene scene = scene_of("[run]\nend_time = 3\n[quick.rum]\nend_time = 1\n");
    scene.root().section("run").number("end_time", "s");
    EXPECT_EQ(faults(scene), "s.toml:3: quick.rum (unknown key; did you mean quick.run?)");
}

TEST(Scene, OverridesAreStrongest) {
    const Scene scene = scene_of(with_quick, true,
                                 {"run.end_time=2 s", "run.name = two words", "run.center=[1,\"2 m\"]",
                                  "body[0].spacing=7", "run.fast=true"});
    const Section run = scene.root().section("run");
    EXPECT_EQ(run.number("end_time", "s"), 2);
    EXPECT_EQ(run.text("name"), "two words");
    EXPECT_EQ(run.numbers("center", "m", 2), (std::vector<double>{1, 2}));
    EXPECT_TRUE(run.flag("fast"));
    EXPECT_EQ(scene.root().sections("body").at(0).number("spacing", "m"), 7);
    EXPECT_EQ(faults(scene), "");
}

TEST(Scene, OverridesAreNamedInFaults) {
    const Scene scene = scene_of("[run]\nend_time = 1\n", false, {"run.end_tme=2", "run.end_time=3 kg"});
    scene.root().section("run").number("end_time", "s");
    EXPECT_EQ(faults(scene),
              "--set run.end_tme: run.end_tme = 2 (unknown key; did you mean run.end_time?)\n"
              "--set run.end_time: run.end_time = \"3 kg\" ('3 kg' is a mass; expected: time [s])");
    EXPECT_EQ(parse_failure("", {"nothing"}), "--set nothing: expected key.path=value");
    EXPECT_EQ(parse_failure("[[body]]\nr = 1\n", {"body[2].r=1"}),
              "--set body[2].r: the scene has no element body[2] (body holds 1)");
    EXPECT_EQ(parse_failure("", {"a[x].r=1"}), "--set a[x].r: 'a[x]' is not a key");
}

TEST(Scene, WrongKindsAreFaultsNotCrashes) {
    const Scene scene = scene_of("run = 3\nbody = [1, 2]\n[end_time]\nx = 1\n[lone]\ny = 1\n");
    scene.root().section("run").number("end_time", "s", 1);
    EXPECT_TRUE(scene.root().sections("body").empty());
    scene.root().number("end_time", "s", 1);
    ASSERT_EQ(scene.root().sections("lone").size(), 1U);
    EXPECT_EQ(scene.root().sections("lone")[0].integer("y"), 1);
    EXPECT_EQ(faults(scene),
              "s.toml:1: run = 3 (not a table; allowed: keys below [run])\n"
              "s.toml:2: body = [1, 2] (not an array of tables; allowed: [[body]])\n"
              "s.toml:3: end_time = a table (not a number; allowed: a number in s, or text with a unit)");
}

TEST(Scene, KeysLookedForButNotReadAreFaults) {
    const Scene scene = scene_of("a = 1\nb = inf\n");
    EXPECT_TRUE(scene.root().has("a"));
    scene.root().number("b", "m");
    EXPECT_EQ(faults(scene),
              "s.toml:1: a = 1 (not used with the other choices of this scene)\n"
              "s.toml:2: b = inf (not finite; allowed: a number in m, or text with a unit)");
}

TEST(Scene, FaultsOfCallersAreAtTheirLines) {
    const Scene scene = scene_of("x = 1\n[[body]]\nr = 1\n");
    const Section body = scene.root().sections("body")[0];
    body.number("r", "m");
    scene.root().integer("x");
    body.error("", "overlaps another body");
    body.error("speed", "needed for a projectile");
    scene.root().section("gas").error("gamma", "needed");
    EXPECT_EQ(faults(scene),
              "s.toml: gas.gamma (needed)\n"
              "s.toml:2: body[0] (overlaps another body)\n"
              "s.toml:2: body[0].speed (needed for a projectile)");
}

TEST(Scene, ResolvedReadsBack) {
    const auto read = [](const Scene& scene) {
        const Section root = scene.root();
        std::string seen = root.text("title", "none\n\"x\"");
        for (const Section& body : root.sections("body")) {
            seen += std::to_string(body.number("radius", "m", 0.1));
            seen += std::to_string(body.section("shape").section("deep").integer("n", 4));
        }
        seen += std::to_string(root.section("run").number("end_time", "s"));
        seen += root.section("run").texts("names", 0, std::vector<std::string>{"p"})[0];
        return seen;
    };
    const Scene first = scene_of("[run]\nend_time = '0.1 ms'\n[[body]]\nradius = '3.2 cm'\n[[body]]\n");
    const std::string seen = read(first);
    EXPECT_EQ(faults(first), "");
    EXPECT_EQ(first.resolved(),
              "# s.toml, as understood: SI units, defaults included\n"
              "title = \"none\\u000A\\\"x\\\"\"  # default\n"
              "\n[[body]]\nradius = 0.032  # m\n\n[body.shape.deep]\nn = 4  # default\n"
              "\n[[body]]\nradius = 0.1  # m, default\n\n[body.shape.deep]\nn = 4  # default\n"
              "\n[run]\nend_time = 0.0001  # s\nnames = [\"p\"]  # default\n");
    const Scene second = scene_of(first.resolved());
    EXPECT_EQ(read(second), seen);
    EXPECT_EQ(faults(second), "");
}

TEST(Spelling, Distance) {
    EXPECT_EQ(spelling_distance("kitten", "sitting"), 3U);
    EXPECT_EQ(spelling_distance("tiem", "time"), 1U);
    EXPECT_EQ(spelling_distance("", "abc"), 3U);
    EXPECT_EQ(nearest_spelling("radus", {"radius", "material"}), "radius");
    EXPECT_EQ(nearest_spelling("colour", {"radius", "material"}), "");
    EXPECT_EQ(nearest_spelling("bodies", {"body", "box"}), "body");
}

}  // namespace
}  // namespace talus
