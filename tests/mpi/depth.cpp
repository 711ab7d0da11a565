#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <memory>

#include "domain/depth_fields.hpp"
#include "src/setup/depth_scene.hpp"
#include "tests/support/gathered.hpp"

/// Depth-integrated flows have the same bits on any number of ranks, whoever owns what, and across an
/// interruption, and lose no volume.
namespace talus::test {
namespace {

constexpr int steps = 40;

std::shared_ptr<const Terrain> bumpy_slope() {
    TerrainGrid grid{{-60, -60}, {4, 4}, 31, 31, {}};
    for (std::size_t row = 0; row < grid.rows; ++row)
        for (std::size_t column = 0; column < grid.columns; ++column) {
            const double x = -60 + 4 * static_cast<double>(column), y = -60 + 4 * static_cast<double>(row);
            grid.elevations.push_back(-0.6 * x + std::sin(0.2 * x) * std::cos(0.3 * y));
        }
    return std::make_shared<const Terrain>(std::move(grid));
}

Release cap(double x, double spacing) {
    Release release;
    release.name = "cap";
    release.shape = SphereShape{{x, 3, 0}, 20};
    release.spacing = spacing;
    release.depth = 2;
    release.parabolic = true;
    return release;
}

/// Runs over the rim of its terrain and takes up what lies on its way.
DepthScene avalanche() {
    DepthScene scene;
    DepthSetup& setup = scene.simulation;
    setup.box.dimension = 2;
    setup.terrain = bumpy_slope();
    setup.friction = depth::Voellmy{.friction = 0.2, .turbulence = 500};
    setup.settings.form = depth::Form::bed_fitted;
    setup.settings.entrainment = 0.005;
    setup.settings.earth_pressure = depth::EarthPressure{.active = 0.8, .passive = 2};
    setup.settings.largest_smoothing_length = 10;
    scene.releases = {cap(30, 2)};
    scene.releases.front().velocity = {12, 1, 0};
    return scene;
}

/// Two flows run into each other, and columns that crowd between them merge.
DepthScene crowd() {
    DepthScene scene = avalanche();
    scene.simulation.settings.earth_pressure.reset();
    scene.simulation.settings.merging_distance = 1.6;
    scene.releases = {cap(30, 2), cap(-12, 2)};
    scene.releases.front().velocity = {-9, 1, 0};
    scene.releases.back().velocity = {9, 0, 0};
    return scene;
}

/// A lake and a flood that runs into it between walls.
DepthScene flooded_lake() {
    DepthScene scene;
    DepthSetup& setup = scene.simulation;
    setup.box = {2, {-50, -40, 0}, {50, 40, 0}, {Boundary::reflecting, Boundary::periodic, Boundary::open}};
    setup.terrain = bumpy_slope();
    setup.friction = depth::Manning{.roughness = 0.05};
    setup.settings.balance = true;
    setup.settings.largest_smoothing_length = 12;
    Release lake;
    lake.name = "lake";
    lake.shape = BoxShape{{20, -40, 0}, {50, 40, 0}};
    lake.spacing = 2;
    lake.level = -15;
    scene.releases = {lake, cap(-10, 2)};
    scene.releases.back().parabolic = false;
    return scene;
}

/// Solid and water through each other, round a periodic side and off a mirror.
DepthScene debris() {
    DepthScene scene;
    DepthSetup& setup = scene.simulation;
    setup.box = {2, {-50, -20, 0}, {50, 20, 0}, {Boundary::reflecting, Boundary::periodic, Boundary::open}};
    setup.terrain = bumpy_slope();
    setup.friction = depth::Coulomb{.friction = 0.4};
    setup.settings.form = depth::Form::bed_fitted;
    setup.settings.eta = 2;
    setup.settings.largest_smoothing_length = 12;
    setup.settings.two_phase = depth::TwoPhase{.speed = 0.5};
    setup.pore_pressure = PorePressure{.law = {.coefficient = 0.1}, .points = 3, .ratio = 0.8};
    setup.settings.two_phase->water_friction = depth::Manning{.roughness = 0.05};
    setup.settings.entrainment = 0.005;
    setup.settings.two_phase->bed_saturation = 0.9;
    scene.releases = {cap(25, 3)};
    scene.releases.front().solid_fraction = 0.7;
    scene.releases.front().velocity = {8, 3, 0};
    return scene;
}

DepthScene break_1d() {
    DepthScene scene;
    DepthSetup& setup = scene.simulation;
    setup.box = {1, {-20, 0, 0}, {20, 0, 0}, {Boundary::reflecting}};
    setup.terrain = std::make_shared<const Terrain>(0.0, std::array<double, 2>{});
    setup.friction = depth::Coulomb{.friction = 0.1};
    setup.settings.eta = 1.6;
    setup.settings.largest_smoothing_length = 10;
    Release release;
    release.shape = BoxShape{{-20, 0, 0}, {0, 0, 0}};
    release.spacing = 0.1;
    release.depth = 1;
    scene.releases = {release};
    return scene;
}

struct How {
    PartitionMethod partition = PartitionMethod::metis;
    int rebalance_interval = 10;
};

DepthSetup setup_of(const DepthScene& scene, const How& how) {
    DepthSetup setup = scene.simulation;
    setup.partition = how.partition;
    setup.rebalance_interval = how.rebalance_interval;
    return setup;
}

std::uint64_t hash_after(const Communicator& comm, const DepthScene& scene, const How& how) {
    DepthSimulation run(comm, setup_of(scene, how), make_columns(comm, scene));
    run.start();
    for (int k = 0; k < steps; ++k) run.step();
    return state_hash(comm, run.particles());
}

std::uint64_t hash_alone(DepthScene (*scene)()) {
    static std::map<DepthScene (*)(), std::uint64_t> known;
    const Communicator alone(MPI_COMM_SELF);
    if (!known.contains(scene)) known[scene] = hash_after(alone, scene(), {});
    return known[scene];
}

class DepthSameBits : public testing::TestWithParam<DepthScene (*)()> {};

TEST_P(DepthSameBits, WhoeverOwnsWhat) {
    const Communicator world(MPI_COMM_WORLD);
    for (const How& how : {How{PartitionMethod::cheapest, 3}, How{PartitionMethod::slabs, 1},
                           How{PartitionMethod::scrambled, 0}})
        EXPECT_EQ(hash_after(world, GetParam()(), how), hash_alone(GetParam()))
            << "method " << static_cast<int>(how.partition);
}

TEST_P(DepthSameBits, AfterInterruption) {
    const Communicator world(MPI_COMM_WORLD), alone(MPI_COMM_SELF);
    const DepthScene scene = GetParam()();
    for (const int stop : {1, 23}) {
        DepthSimulation first(world, setup_of(scene, {}), make_columns(world, scene));
        first.start();
        const std::uint64_t released = first.total_particles();
        for (int k = 0; k < stop; ++k) first.step();
        const GatheredState saved = gather_state(world, first.particles());
        std::map<std::string, double> numbers;
        first.save_numbers(numbers);
        ParticleSet share = empty_columns(scene.simulation);
        const auto ranks = static_cast<std::size_t>(world.size()),
                   rank = static_cast<std::size_t>(world.rank());
        fill(share, saved, [&](std::size_t k) { return k % ranks == rank; });
        DepthSimulation second(world, setup_of(scene, {PartitionMethod::bisection, 5}), std::move(share));
        second.resume(first.time(), first.time_step(), first.step_count(), numbers);
        const std::uint64_t at_stop = second.total_particles();
        for (int k = stop; k < steps; ++k) second.step();
        if (scene.simulation.settings.merging_distance > 0 && stop > 1) {
            EXPECT_LT(at_stop, released) << "columns must merge before";
            EXPECT_LT(second.total_particles(), at_stop) << "and after";
        }
        EXPECT_EQ(state_hash(world, second.particles()), hash_alone(GetParam())) << "stopped at " << stop;
    }
}

std::string name_of(const testing::TestParamInfo<DepthScene (*)()>& scene) {
    constexpr const char* names[] = {"Avalanche", "FloodedLake", "Break1D", "Debris", "Crowd"};
    return names[scene.index];
}
INSTANTIATE_TEST_SUITE_P(Scenes, DepthSameBits,
                         testing::Values(avalanche, flooded_lake, break_1d, debris, crowd), name_of);

// What is there at the end and what has left is what was released: nothing is taken up here.
TEST(DepthVolume, IsThereOrHasLeft) {
    const Communicator world(MPI_COMM_WORLD);
    DepthScene scene = avalanche();
    scene.simulation.settings.entrainment = 0;
    DepthSimulation run(world, setup_of(scene, {}), make_columns(world, scene));
    run.start();
    const double released = run.totals().volume;
    const std::uint64_t particles = run.total_particles();
    while (run.time() < 4) run.step();
    EXPECT_GT(run.outflow().count(), 10u);
    EXPECT_GT(run.total_particles(), 10u);
    EXPECT_EQ(run.total_particles() + run.outflow().count(), particles);
    EXPECT_NEAR(run.totals().volume + run.outflow().volume(), released, 1e-13 * released);
    EXPECT_NE(run.outflow().take_note().find("have left the terrain"), std::string::npos);
    EXPECT_TRUE(run.outflow().take_note().empty());
}

// Merged columns lose neither volume nor momentum: nothing but the flow's collision acts here.
TEST(DepthMerging, KeepsVolumeAndMomentum) {
    const Communicator world(MPI_COMM_WORLD);
    DepthScene scene = crowd();
    DepthSetup& setup = scene.simulation;
    setup.settings.entrainment = 0;
    setup.settings.form = depth::Form::cartesian;
    setup.terrain = std::make_shared<const Terrain>(0.0, std::array<double, 2>{});
    setup.friction = depth::Frictionless{};
    DepthSimulation run(world, setup_of(scene, {}), make_columns(world, scene));
    run.start();
    const DepthTotals before = run.totals();
    const std::uint64_t released = run.total_particles();
    for (int k = 0; k < 2 * steps; ++k) run.step();
    const DepthTotals after = run.totals();
    EXPECT_LT(run.total_particles(), released - released / 20);
    EXPECT_GT(run.total_particles(), released / 4);
    EXPECT_NEAR(after.volume, before.volume, 1e-13 * before.volume);
    const double density = setup.settings.density;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        EXPECT_NEAR(after.momentum[axis], before.momentum[axis], 1e-12 * density * before.volume * 9);
        // The centre of all moves as without merging.
        EXPECT_NEAR(after.centre[axis],
                    before.centre[axis] + before.momentum[axis] / (density * before.volume) * run.time(),
                    1e-11);
    }
    EXPECT_LT(after.kinetic_energy + after.potential_energy, before.kinetic_energy + before.potential_energy);
}

// On every rank, naming a particle that it has reached, and no rank hangs.
TEST(DepthFault, AVelocityThatIsNoNumberStopsTheRun) {
    const Communicator world(MPI_COMM_WORLD);
    const DepthScene scene = avalanche();
    ParticleSet particles = make_columns(world, scene);
    for (std::size_t i = 0; i < particles.size(); ++i)
        if (particles.data(field::id)[i] == 17)
            particles.data(field::velocity, 1)[i] = std::numeric_limits<double>::quiet_NaN();
    DepthSimulation run(world, setup_of(scene, {}), std::move(particles));
    try {
        run.start();
        for (int k = 0; k < steps; ++k) run.step();
        ADD_FAILURE() << "no error";
    } catch (const AgreedError& error) {
        EXPECT_EQ(error.exit_code, 1);
        EXPECT_NE(std::string(error.what()).find("of particle "), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("is not finite"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace talus::test
