#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "domain/clump_fields.hpp"
#include "io/agree.hpp"
#include "src/setup/water_scene.hpp"
#include "src/water/water_record.hpp"
#include "tests/support/gathered.hpp"

namespace talus::test {
namespace {

/// A heap of water that falls apart in a tank whose floor moves, with all that water may have.
constexpr const char* plane = R"(dimension = 2
[box]
boundaries = ["reflecting", "open"]
lower = [0, -0.1]
upper = [0.8, 1]
[water]
greatest_speed = 3
gravity = [0, -9.81]
viscosity = 0.5
artificial_viscosity = 0.05
shifting = 1
[[body]]
name = "water"
shape = "box"
lower = [0, 0]
upper = [0.3, 0.4]
lattice = "cubic"
spacing = 0.02
surface = 0.4
[[body]]
name = "floor"
shape = "box"
lower = [0, -0.1]
upper = [0.8, 0]
lattice = "cubic"
wall = "no_slip"
record_force = true
motion = { velocity = [0, 0.2] }
[run]
end_time = 1
rebalance_interval = 2
)";

/// The same in a box that is periodic across, with a floor that slips.
constexpr const char* space = R"(dimension = 3
[box]
boundaries = ["reflecting", "periodic", "open"]
lower = [0, 0, -0.16]
upper = [0.64, 0.32, 1]
[water]
greatest_speed = 3
gravity = [0, 0, -9.81]
artificial_viscosity = 0.05
[[body]]
name = "water"
shape = "box"
lower = [0, 0, 0]
upper = [0.24, 0.32, 0.32]
lattice = "cubic"
spacing = 0.04
surface = 0.32
[[body]]
name = "floor"
shape = "box"
lower = [0, 0, -0.16]
upper = [0.64, 0.32, 0]
lattice = "cubic"
wall = "free_slip"
record_force = true
[run]
end_time = 1
rebalance_interval = 2
)";

/// A channel that water enters with a profile of speeds, on a floor, and leaves.
constexpr const char* channel = R"(dimension = 2
[water]
greatest_speed = 4
gravity = [0, -9.81]
artificial_viscosity = 0.05
shifting = 1
[[body]]
name = "floor"
shape = "box"
lower = [-0.08, -0.08]
upper = [0.58, 0]
lattice = "cubic"
spacing = 0.02
wall = "no_slip"
[[body]]
name = "inlet"
shape = "box"
lower = [-0.08, 0]
upper = [0, 0.2]
lattice = "cubic"
surface = 0.2
inflow = { direction = "+x", places = [0, 0.2], speeds = [1, 4] }
[[body]]
name = "water"
shape = "box"
lower = [0, 0]
upper = [0.5, 0.2]
lattice = "cubic"
velocity = [3, 0]
surface = 0.2
[[body]]
name = "outlet"
shape = "box"
lower = [0.5, 0]
upper = [0.58, 0.2]
lattice = "cubic"
velocity = [3, 0]
surface = 0.2
outflow = { direction = "+x" }
[run]
end_time = 1
rebalance_interval = 2
)";

/// A cube that leans on a floor and a ball that meets its image across a periodic boundary, both half in
/// water that falls apart.
constexpr const char* bodies = R"(dimension = 3
[box]
boundaries = ["open", "periodic", "open"]
lower = [-0.2, 0, -0.16]
upper = [1, 0.4, 1]
[water]
greatest_speed = 3
gravity = [0, 0, -9.81]
artificial_viscosity = 0.05
[dem]
law = "linear"
stiffness = 1e5
[materials.wood]
density = 500
restitution = 0.5
friction = 0.4
[[body]]
name = "water"
shape = "box"
lower = [0, 0, 0]
upper = [0.32, 0.4, 0.24]
lattice = "cubic"
spacing = 0.04
surface = 0.24
[[body]]
name = "floor"
shape = "box"
lower = [0, 0, -0.16]
upper = [0.64, 0.4, 0]
lattice = "cubic"
wall = "free_slip"
record_force = true
[[body]]
name = "cube"
shape = "box"
lower = [0.24, 0, 0]
upper = [0.44, 0.2, 0.2]
lattice = "cubic"
wall = "no_slip"
rigid = { material = "wood", spin = [0, 2, 1] }
[[body]]
name = "ball"
shape = "sphere"
centre = [0.24, 0.28, 0.3]
radius = 0.12
lattice = "cubic"
wall = "free_slip"
rigid = { material = "wood", velocity = [0.5, 3, -3] }
[[wall]]
kind = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
material = "wood"
[run]
end_time = 1
rebalance_interval = 2
)";

/// The first as mud.
const std::string mud = [] {
    std::string text = plane;
    const std::string viscosity = "viscosity = 0.5\n";
    text.replace(text.find(viscosity), viscosity.size(), "");
    return text + "[water.rheology]\nyield_stress = 200\nconsistency = 5\nexponent = 0.6\n";
}();

constexpr int steps = 20, stop = 7;

/// Of the bodies of the channel.
constexpr std::uint8_t outlet = 3;

WaterScene scene_of(const Communicator& comm, const char* text, PartitionMethod method) {
    WaterScene scene = read_water_scene(comm, Scene::parse(text, "water.toml"));
    scene.simulation.partition = method;
    return scene;
}

/// What the diagnostics say of walls and of two gauges.
std::vector<double> measured(const WaterScene& scene, WaterSimulation& simulation) {
    std::vector<double> row;
    const Point low{0.1, 0.02, 0.02}, high{0.2, 0.2, 0.2};
    WaterRecord(scene.simulation, scene.body_names(), {{"low", low}, {"high", high}})
        .measure(simulation, row);
    return row;
}

/// All that a checkpoint would hold, and what was measured.
struct Outcome {
    GatheredState water, bodies, contacts;
    std::map<std::string, double> numbers;
    std::vector<double> measured;
    bool operator==(const Outcome&) const = default;
};

Outcome outcome_of(const Communicator& comm, const WaterScene& scene, WaterSimulation& simulation) {
    Outcome found;
    found.water = gather_state(comm, simulation.particles());
    simulation.save_numbers(found.numbers);
    if (const RigidBodies* rigid = simulation.rigid()) {
        EXPECT_GT(rigid->substeps(), 1) << "bodies must touch";
        found.bodies = gather_state(comm, rigid->saved_states());
        found.contacts = gather_state(comm, rigid->saved_contacts());
    }
    found.measured = measured(scene, simulation);
    return found;
}

Outcome run(const Communicator& comm, const char* text, PartitionMethod method) {
    const WaterScene scene = scene_of(comm, text, method);
    WaterSimulation simulation(comm, scene.simulation, make_water(comm, scene));
    simulation.start();
    for (int k = 0; k < steps; ++k) simulation.step();
    return outcome_of(comm, scene, simulation);
}

class WaterSameBits : public testing::TestWithParam<const char*> {};

TEST_P(WaterSameBits, OnAnyRanks) {
    const Communicator alone(MPI_COMM_SELF), world(MPI_COMM_WORLD);
    const Outcome expected = run(alone, GetParam(), PartitionMethod::slabs);
    EXPECT_GT(expected.water.ids.size(), 400u);
    EXPECT_NE(expected.measured.front(), 0);
    EXPECT_NE(expected.measured.back(), 0);
    for (const PartitionMethod method : {PartitionMethod::cheapest, PartitionMethod::scrambled})
        EXPECT_TRUE(run(world, GetParam(), method) == expected);
}

// Stopped, and gone on with by ranks that hold other particles.
TEST_P(WaterSameBits, AfterInterruption) {
    const Communicator alone(MPI_COMM_SELF), world(MPI_COMM_WORLD);
    const WaterScene scene = scene_of(world, GetParam(), PartitionMethod::scrambled);
    WaterSimulation first(world, scene.simulation, make_water(world, scene));
    first.start();
    for (int k = 0; k < stop; ++k) first.step();
    const GatheredState saved = gather_state(world, first.particles());
    std::optional<ParticleSet> states, contacts;
    if (const RigidBodies* rigid = first.rigid()) {
        states = rigid->saved_states();
        contacts = rigid->saved_contacts();
        EXPECT_GT(world.all_sum(contacts->size()), 0u);
    }
    std::map<std::string, double> numbers;
    first.save_numbers(numbers);
    ParticleSet particles = empty_water(scene.simulation);
    fill(particles, saved, [&, total = saved.ids.size()](std::size_t k) {
        return k * static_cast<std::size_t>(world.size()) / total == static_cast<std::size_t>(world.rank());
    });
    WaterSetup other = scene.simulation;
    other.partition = PartitionMethod::bisection;
    WaterSimulation second(world, other, std::move(particles));
    if (states) second.rigid()->restore(*states, *contacts);
    second.resume(first.time(), first.time_step(), first.step_count(), numbers);
    for (int k = stop; k < steps; ++k) second.step();
    EXPECT_TRUE(outcome_of(world, scene, second) == run(alone, GetParam(), PartitionMethod::slabs));
}

std::string name_of(const testing::TestParamInfo<const char*>& scene) {
    constexpr std::array names{"plane", "space", "channel", "mud", "bodies"};
    return names[scene.index];
}

INSTANTIATE_TEST_SUITE_P(Scenes, WaterSameBits, testing::Values(plane, space, channel, mud.c_str(), bodies),
                         name_of);

// Water that flows upwards, too, has left that behind once it is the outflow's.
TEST(OutflowOfWater, MovesAlongItsAxisAlone) {
    const Communicator world(MPI_COMM_WORLD);
    std::string text = channel;
    const std::string flows = "velocity = [3, 0]";
    text.replace(text.find(flows), flows.size(), "velocity = [3, 0.4]");
    const WaterScene scene = scene_of(world, text.c_str(), PartitionMethod::cheapest);
    WaterSimulation simulation(world, scene.simulation, make_water(world, scene));
    simulation.start();
    for (int k = 0; k < steps; ++k) simulation.step();
    const ParticleSet& water = simulation.particles();
    std::uint64_t arrived = 0;
    for (std::size_t i = 0; i < water.size(); ++i) {
        if (water.data(field::body)[i] != outlet) continue;
        EXPECT_EQ(water.data(field::velocity, 1)[i], 0);
        const double height = water.data(field::position, 1)[i] / 0.02 - 0.5;
        arrived += std::abs(height - std::round(height)) > 1e-6 ? 1 : 0;  // off the rows of the start
    }
    EXPECT_GT(world.all_sum(arrived), 0u);
}

/// What a run says on every rank after a value of the particle with this id has been spoilt on the rank that
/// has it.
std::string said_after(const Field<double>& field, double value, std::uint64_t id) {
    const Communicator world(MPI_COMM_WORLD);
    const WaterScene scene = scene_of(world, plane, PartitionMethod::cheapest);
    WaterSimulation simulation(world, scene.simulation, make_water(world, scene));
    simulation.start();
    simulation.step();
    ParticleSet& particles = simulation.access().particles;
    const auto ids = std::as_const(particles).own(field::id);
    if (const auto found = std::find(ids.begin(), ids.end(), id); found != ids.end())
        particles.data(field)[found - ids.begin()] = value;
    try {
        simulation.step();
    } catch (const AgreedError& failure) {
        EXPECT_EQ(failure.exit_code, 1);
        return failure.what();
    }
    return "nothing";
}

// A value that is not finite, or a density that is none, ends the run on all ranks with the particle it is
// of.
TEST(WaterFaults, AreNamed) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(said_after(field::velocity, nan, 17).find("in set 'water' is not finite"), std::string::npos);
    EXPECT_NE(said_after(field::density, nan, 17).find("in set 'water' is not finite"), std::string::npos);
    const std::string said = said_after(field::density, -500, 17);
    EXPECT_NE(said.find("a density that is not positive at particle 17"), std::string::npos) << said;
}

TEST(WaterFaults, NameTheRigidBody) {
    const Communicator world(MPI_COMM_WORLD);
    const WaterScene scene = scene_of(world, bodies, PartitionMethod::cheapest);
    WaterSimulation simulation(world, scene.simulation, make_water(world, scene));
    simulation.start();
    ParticleSet states = simulation.rigid()->saved_states();
    if (states.size() > 0)
        states.data(field::clump_velocity, 0)[0] = std::numeric_limits<double>::quiet_NaN();
    simulation.rigid()->restore(states, simulation.rigid()->saved_contacts());
    try {
        simulation.step();
        ADD_FAILURE() << "it went on";
    } catch (const AgreedError& failure) {
        const std::string said = failure.what();
        EXPECT_NE(said.find("rigid body '" + simulation.rigid()->body(0).name), std::string::npos) << said;
        EXPECT_NE(said.find("a state that is not finite"), std::string::npos) << said;
    }
}

}  // namespace
}  // namespace talus::test
