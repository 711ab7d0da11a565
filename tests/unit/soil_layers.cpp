#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "comm/communicator.hpp"
#include "tests/support/own_folder.hpp"
#include "tests/support/soil_run.hpp"

namespace talus::test {
namespace {

constexpr const char* layers = R"(dimension = 1
[soil]
spacing = 0.5
gravity = [-10]
damping = 20
[materials.light]
density = 2000
youngs_modulus = 1e7
poisson_ratio = 0.2
[materials.heavy]
density = 4000
youngs_modulus = 1e7
poisson_ratio = 0.2
[[body]]
name = "below"
material = "light"
shape = "box"
lower = [0]
upper = [5]
[[body]]
name = "above"
material = "heavy"
shape = "box"
lower = [5]
upper = [10]
[[boundary]]
name = "base"
kind = "fixed"
face = "x_lower"
[run]
end_time = 8
)";

// Once a column of two layers has come to rest its base bears its weight, (2000 + 4000) kg/m3 5 m 10 m/s2.
// What is left of the motion is 2.5e-9 after 4 s, and the square of it after the 8 s here.
TEST(SoilLayers, BaseBearsTheWeightOfBoth) {
    const Communicator comm(MPI_COMM_SELF);
    const OwnFolder folder;
    const std::filesystem::path file = folder.path / "layers.toml";
    std::ofstream(file) << layers;
    const SoilScene scene = soil_scene(comm, file, {});
    double force = 0;
    run_soil(comm, scene, [&](const SoilSimulation& run) { force = run.totals().forces[0][0]; });
    EXPECT_NEAR(std::abs(force), 3e5, 1e-10 * 3e5);
}

}  // namespace
}  // namespace talus::test
