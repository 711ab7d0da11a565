#include <gtest/gtest.h>

#include <map>
#include <string>

#include "domain/soil_fields.hpp"
#include "src/setup/soil_scene.hpp"
#include "tests/support/gathered.hpp"

/// Soil on two grids has the same bits on any number of ranks, whoever owns what, and across an interruption.
namespace talus::test {
namespace {

constexpr int steps = 20;

constexpr const char* layers = R"(dimension = 2
[soil]
spacing = 0.5
gravity = [0, -10]
[materials.clay]
density = 2000
youngs_modulus = 1e7
poisson_ratio = 0.3
[materials.clay.yield]
kind = "drucker_prager"
cohesion = 5e3
friction_angle = 0.3
hardening = -1e5
residual = 1e3
fluidity = 10
[materials.sand]
density = 1700
youngs_modulus = 1e7
poisson_ratio = 0.25
[[body]]
name = "below"
material = "sand"
shape = "box"
lower = [0, 0]
upper = [8, 2]
[[body]]
name = "above"
material = "clay"
shape = "box"
lower = [0, 2]
upper = [4, 6]
velocity = [1, -2]
[[boundary]]
name = "base"
kind = "fixed"
face = "y_lower"
[[boundary]]
name = "load"
kind = "traction"
face = "y_upper"
lower = [1, 6]
upper = [3, 6]
traction = [0, -5e4]
[run]
end_time = 1
)";

constexpr const char* saturated = R"(dimension = 2
[soil]
spacing = 0.5
saturated = true
gravity = [0, -10]
[materials.soil]
density = 2000
youngs_modulus = 3e7
poisson_ratio = 0.2
permeability = 1e-9
mixture_stiffness = 1e10
[materials.soil.yield]
kind = "von_mises"
yield_stress = 1e4
fluidity = 10
[[body]]
name = "stratum"
material = "soil"
shape = "box"
lower = [0, 0]
upper = [6, 4]
[[boundary]]
name = "load"
kind = "traction"
face = "y_upper"
upper = [2, 4]
traction = [0, -1e5]
[[boundary]]
name = "base"
kind = "fixed"
face = "y_lower"
[[boundary]]
name = "left"
kind = "free_slip"
face = "x_lower"
[[boundary]]
name = "right"
kind = "free_slip"
face = "x_upper"
[[boundary]]
name = "surface"
kind = "drained"
face = "y_upper"
[run]
end_time = 1
)";

constexpr const char* cube = R"(dimension = 3
[soil]
deformation = "large"
spacing = 0.5
gravity = [0, 0, -10]
[materials.clay]
density = 2000
youngs_modulus = 1e6
poisson_ratio = 0.3
[materials.clay.yield]
kind = "von_mises"
yield_stress = 5e3
fluidity = 10
[[body]]
name = "cube"
material = "clay"
shape = "box"
lower = [0, 0, 0]
upper = [2, 2, 3]
velocity = [5, 2, -3]
[[boundary]]
name = "base"
kind = "fixed"
face = "z_lower"
[run]
end_time = 1
)";

SoilScene scene_of(const char* text, const std::vector<std::string>& overrides = {}) {
    const Communicator alone(MPI_COMM_SELF);
    return read_soil_scene(alone, Scene::parse(text, "soil.toml", false, overrides));
}
SoilScene small_strain() { return scene_of(layers); }
SoilScene with_water() { return scene_of(saturated); }
/// Its surface lets no water through.
SoilScene sealed() {
    return scene_of(
        saturated, {"boundary[4].kind=traction", "boundary[4].traction=[0,-1e3]", "boundary[4].lower=[3,4]"});
}
SoilScene moving_2d() { return scene_of(layers, {"soil.deformation=large"}); }
SoilScene moving_3d() { return scene_of(cube); }

struct How {
    PartitionMethod partition = PartitionMethod::metis;
    int start = 0;  ///< of particles: rank (id + start) modulo the ranks
};

ParticleSet share_of(const Communicator& comm, const SoilScene& scene, const GatheredState& state,
                     int start) {
    ParticleSet mine = empty_soil(scene.simulation);
    const auto ranks = static_cast<std::size_t>(comm.size());
    fill(mine, state, [&](std::size_t k) {
        return (k * 7 + static_cast<std::size_t>(start)) % ranks == static_cast<std::size_t>(comm.rank());
    });
    return mine;
}

SoilSimulation prepare(const Communicator& comm, const SoilScene& scene, const GatheredState& state,
                       const How& how) {
    SoilSetup setup = scene.simulation;
    setup.partition = how.partition;
    return SoilSimulation(comm, setup, share_of(comm, scene, state, how.start));
}

GatheredState state_at_start(const SoilScene& scene) {
    const Communicator alone(MPI_COMM_SELF);
    return gather_state(alone, make_soil(alone, scene));
}

std::uint64_t hash_after(const Communicator& comm, const SoilScene& scene, const How& how) {
    SoilSimulation run = prepare(comm, scene, state_at_start(scene), how);
    run.start();
    for (int k = 0; k < steps; ++k) run.step();
    return state_hash(comm, run.particles());
}

std::uint64_t hash_alone(SoilScene (*scene)()) {
    static std::map<SoilScene (*)(), std::uint64_t> known;
    const Communicator alone(MPI_COMM_SELF);
    if (!known.contains(scene)) known[scene] = hash_after(alone, scene(), {});
    return known[scene];
}

class SoilSameBits : public testing::TestWithParam<SoilScene (*)()> {};

TEST_P(SoilSameBits, SomethingHappens) {
    const Communicator alone(MPI_COMM_SELF);
    const SoilScene scene = GetParam()();
    SoilSimulation run = prepare(alone, scene, state_at_start(scene), {});
    run.start();
    for (int k = 0; k < steps; ++k) run.step();
    const SoilTotals totals = run.totals();
    EXPECT_GT(totals.greatest_viscoplastic_strain, 1e-6);
    EXPECT_GT(totals.greatest_displacement, 1e-5);
    if (scene.simulation.saturated) {
        EXPECT_GT(totals.greatest_pore_pressure, 1e3);
    }
}

TEST_P(SoilSameBits, WhoeverOwnsWhat) {
    const Communicator world(MPI_COMM_WORLD);
    const SoilScene scene = GetParam()();
    for (const How& how : {How{PartitionMethod::cheapest, 3}, How{PartitionMethod::slabs, 1},
                           How{PartitionMethod::scrambled, 0}})
        EXPECT_EQ(hash_after(world, scene, how), hash_alone(GetParam()))
            << "method " << static_cast<int>(how.partition);
}

TEST_P(SoilSameBits, AfterInterruption) {
    const Communicator world(MPI_COMM_WORLD);
    const SoilScene scene = GetParam()();
    for (const int stop : {1, 13}) {
        SoilSimulation first = prepare(world, scene, state_at_start(scene), {});
        first.start();
        for (int k = 0; k < stop; ++k) first.step();
        SoilSimulation second =
            prepare(world, scene, gather_state(world, first.particles()), {PartitionMethod::bisection, 5});
        second.resume(first.time(), first.step_count());
        for (int k = stop; k < steps; ++k) second.step();
        EXPECT_EQ(state_hash(world, second.particles()), hash_alone(GetParam())) << "stopped at " << stop;
    }
}

std::string name_of(const testing::TestParamInfo<SoilScene (*)()>& scene) {
    constexpr const char* names[] = {"Layers", "Saturated", "Moving2D", "Moving3D", "Sealed"};
    return names[scene.index];
}
INSTANTIATE_TEST_SUITE_P(Scenes, SoilSameBits,
                         testing::Values(small_strain, with_water, moving_2d, moving_3d, sealed), name_of);

}  // namespace
}  // namespace talus::test
