#include <gtest/gtest.h>

#include <string>

#include "domain/soil_fields.hpp"
#include "src/setup/soil_scene.hpp"

namespace talus {
namespace {

const std::string good = R"(dimension = 2
[soil]
spacing = 0.5
[materials.clay]
density = 2000
youngs_modulus = 8e7
poisson_ratio = 0.3
[materials.clay.yield]
kind = "drucker_prager"
cohesion = 1e4
friction_angle = "30 deg"
fluidity = 2
[[body]]
material = "clay"
shape = "box"
lower = [0, 0]
upper = [4, 1]
[[body]]
material = "clay"
shape = "box"
lower = [0, 1]
upper = [2, 2]
[[boundary]]
name = "base"
kind = "fixed"
face = "y_lower"
[run]
end_time = 1
)";

SoilScene read(const std::string& text) {
    const Communicator comm(MPI_COMM_SELF);
    const Scene scene = Scene::parse(text, "soil.toml");
    return read_soil_scene(comm, scene);
}

std::string replaced(const std::string& what, const std::string& by) {
    std::string text = good;
    text.replace(text.find(what), what.size(), by);
    return text;
}

void expect_fault(const std::string& text, const std::string& part) {
    try {
        read(text);
        ADD_FAILURE() << "no fault: " << part;
    } catch (const SceneError& error) {
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
}

TEST(SoilScene, FaultsAreNamed) {
    expect_fault(replaced("upper = [4, 1]", "upper = [4.1, 1]"), "is not a whole number of spacings");
    expect_fault(replaced("face = \"y_lower\"", "face = \"below\""), "'below' is no face");
    expect_fault(replaced("30 deg", "95 deg"), "friction_angle");
    expect_fault(replaced("kind = \"fixed\"", "kind = \"drained\""), "needs soil.saturated = true");
    expect_fault(replaced("material = \"clay\"", "material = \"loam\""),
                 "there is no table [materials.loam]");
    expect_fault(replaced("face = \"y_lower\"", "face = \"y_lower\"\nupper = [-1, 0]"), "holds at no node");
    expect_fault(replaced("[run]", "[initial_stress]\nsurface = 2\nlateral_ratio = 0.5\n[run]"),
                 "needs soil.gravity");
    expect_fault(replaced("spacing = 0.5", "spacing = 0.5\nsaturated = true"), "permeability");
}

TEST(SoilScene, NodesKnowTheirFacesAndShareTheMass) {
    const Communicator comm(MPI_COMM_SELF);
    const ParticleSet soil = make_soil(comm, read(good));
    double nodes = 0, elements = 0;
    int inwards = 0, on_base = 0;
    for (std::size_t i = 0; i < soil.size(); ++i) {
        const bool is_node = soil.data(soil_field::grid)[i] == soil::node_grid;
        (is_node ? nodes : elements) += soil.data(field::mass)[i];
        inwards += is_node && soil.data(soil_field::faces)[i] == soil_field::turns_inwards;
        on_base += is_node && soil.data(soil_field::conditions)[i] == 1;
    }
    EXPECT_DOUBLE_EQ(nodes, 2000 * 6);
    EXPECT_DOUBLE_EQ(elements, 2000 * 6);
    EXPECT_EQ(inwards, 1);  // where the upper box ends
    EXPECT_EQ(on_base, 9);
}

}  // namespace
}  // namespace talus
