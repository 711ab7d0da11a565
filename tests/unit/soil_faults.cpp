#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "domain/soil_fields.hpp"
#include "tests/support/soil_run.hpp"

namespace talus::test {
namespace {

constexpr const char* block = R"(dimension = 2
[soil]
spacing = 0.1
[materials.soil]
density = 2000
youngs_modulus = 1e7
poisson_ratio = 0.2
[[body]]
name = "block"
material = "soil"
shape = "box"
lower = [0, 0]
upper = [0.3, 0.7]
[[boundary]]
name = "base"
kind = "fixed"
face = "y_lower"
[run]
end_time = 1
)";

SoilScene scene_of(const std::vector<std::string>& overrides) {
    const Communicator alone(MPI_COMM_SELF);
    return read_soil_scene(alone, Scene::parse(block, "soil.toml", false, overrides));
}

/// What a run says after a value of the particle with this id has become NaN.
std::string said_after_nan(const std::vector<std::string>& overrides, std::uint64_t id, bool of_water) {
    const Communicator alone(MPI_COMM_SELF);
    const SoilScene scene = scene_of(overrides);
    SoilSimulation run(alone, scene.simulation, make_soil(alone, scene));
    run.start();
    run.step();
    const auto ids = run.particles().own(field::id);
    const auto place = std::find(ids.begin(), ids.end(), id) - ids.begin();
    run.particles().data(of_water ? soil_field::pore_pressure : soil_field::velocity)[place] =
        std::numeric_limits<double>::quiet_NaN();
    try {
        run.step();
    } catch (const AgreedError& failure) {
        EXPECT_EQ(failure.exit_code, 1);
        return failure.what();
    }
    return "nothing";
}

// 0.3/0.1 and 0.7/0.1 are not whole numbers in doubles.
TEST(SoilLattice, SizesOfWholeSpacingsHaveThatManyCells) {
    const SoilScene scene = scene_of({});
    EXPECT_EQ(scene.lattice.cells[0], 3);
    EXPECT_EQ(scene.lattice.cells[1], 7);
    const Communicator alone(MPI_COMM_SELF);
    EXPECT_EQ(make_soil(alone, scene).size(), 4u * 8 + 3 * 7);
}

TEST(SoilFaults, NanNamesAParticle) {
    const std::vector<std::string> large{"soil.deformation=large"};
    const auto names_one = [](const std::string& said) {
        return said.find("of particle ") != std::string::npos && said.find("not finite") != std::string::npos;
    };
    for (const auto& overrides : {std::vector<std::string>{}, large}) {
        const std::string said = said_after_nan(overrides, 17, false);
        EXPECT_TRUE(names_one(said)) << said;
    }
    const std::string said = said_after_nan(
        {"soil.saturated=true", "materials.soil.permeability=1e-8", "materials.soil.mixture_stiffness=1e9",
         "boundary=[{name=\"base\",kind=\"fixed\",face=\"y_lower\"},{name=\"left\",kind=\"free_slip\",face="
         "\"x_lower\"},{name=\"right\",kind=\"free_slip\",face=\"x_upper\"},{name=\"top\",kind=\"drained\","
         "face=\"y_upper\"}]"},
        17, true);
    EXPECT_TRUE(names_one(said)) << said;
}

}  // namespace
}  // namespace talus::test
