#include <gtest/gtest.h>

#include <cmath>

#include "domain/grain_fields.hpp"
#include "tests/support/gathered.hpp"
#include "tests/support/grain_scene.hpp"

/// Grains and what their contacts remember have the same bits on any number of ranks, whoever owns what,
/// however often lists are made, and across an interruption in the middle of contacts.
namespace talus::test {
namespace {

constexpr int steps = 120;

const dem::GrainMaterial glass{.name = "glass",
                               .density = 2500,
                               .youngs_modulus = 1e7,
                               .poisson_ratio = 0.2,
                               .restitution = 0.7,
                               .friction = 0.5,
                               .rolling_friction = 0.1,
                               .rolling_damping = 0.3,
                               .twisting_friction = 0.5,
                               .work_of_adhesion = 1};

/// A dense cloud of two sizes.
std::vector<GrainState> cloud() {
    std::vector<GrainState> grains;
    for (int k = 0; k < 700; ++k) {
        const double radius = k % 3 == 0 ? 0.005 : 0.0035;
        grains.push_back({{0.0102 * (k % 10), 0.0102 * (k / 10 % 10), 0.006 + 0.0102 * (k / 100)},
                          {0.5 * std::sin(3.0 * k), 0.5 * std::cos(5.0 * k), 0.5 * std::sin(7.0 * k) - 1},
                          {30 * std::cos(2.0 * k), 0, 30 * std::sin(k)},
                          radius,
                          2500});
    }
    return grains;
}

template <class Table>
GrainSetup setup_under() {
    const dem::MaterialPairs pairs({glass});
    GrainSetup setup = grain_setup({glass}, 0.005, 2e-5);
    setup.laws = Table{dem::PairTable<typename Table::Law>(1, [&](std::size_t a, std::size_t b) {
        const dem::PairProperties pair = pairs(a, b);
        typename Table::Law law;
        if constexpr (Table::Law::sticks)
            law.elasticity = dem::johnson_kendall_roberts(pair);
        else
            law.elasticity = dem::hertz_mindlin(pair, dem::EndOfContact::may_attract);
        law.friction = {pair.friction};
        law.rolling = {pair.rolling_friction, pair.rolling_damping};
        if constexpr (Table::Law::twists) law.twisting = {pair.twisting_friction};
        return law;
    })};
    setup.gravity = {0, 0, -9.81};
    return setup;
}

/// Of sizes up to 1:5.5, on three levels: large ones, and small ones in the corners of the other places.
std::vector<GrainState> mixture() {
    const std::vector<GrainState> places = cloud();
    std::vector<GrainState> mixed;
    for (std::size_t k = 0; k < 150; ++k) {
        if (k % 3 == 0) {
            mixed.push_back(places[k]);
            continue;
        }
        for (int corner = 0; corner < 8; ++corner) {
            const auto side = [corner](int bit) { return (corner >> bit & 1) != 0 ? 0.0026 : -0.0024; };
            GrainState small = places[k];
            small.position += dem::Vector3<>{side(0), side(1), side(2)};
            small.radius = corner % 3 == 0 ? 0.0024 : 0.0009;
            small.velocity.x += 0.3 * corner;
            mixed.push_back(small);
        }
    }
    return mixed;
}

GrainSetup rolling_setup() {
    return setup_under<dem::LawTable<dem::HertzMindlin, dem::ElasticPlasticRolling>>();
}

/// Periodic along x and y, on a floor that swings.
GrainSetup on_a_floor(GrainSetup setup) {
    setup.box = {
        3, {-0.003, 0.1, 0}, {0.0993, 0.2031, 0}, {Boundary::periodic, Boundary::periodic, Boundary::open}};
    dem::Wall floor{"floor", 0, dem::PlaneShape{{}, {0, 0, 1}}, {}};
    floor.motion.amplitude = {0.0005, 0, 0.0005};
    floor.motion.translation_oscillation = {100, 0};
    setup.walls.push_back(floor);
    return setup;
}

GrainSetup on_a_floor() { return on_a_floor(rolling_setup()); }
/// The same with all that a contact may remember.
GrainSetup sticky_on_a_floor() {
    return on_a_floor(setup_under<dem::LawTable<dem::JohnsonKendallRoberts, dem::ElasticPlasticRolling,
                                                dem::ContactAreaTwisting>>());
}

/// Bonded to lumps and a net through the periodic boundaries that break while they fly apart.
GrainSetup bonded_on_a_floor() {
    GrainSetup setup = on_a_floor();
    setup.bonds.push_back({.bodies = {0, 0},
                           .gap = 0.6,
                           .radius_factor = 0.8,
                           .material = {.youngs_modulus = 1e7,
                                        .poisson_ratio = 0.2,
                                        .tensile_strength = 2e5,
                                        .shear_strength = 2e5,
                                        .damping_ratio = 0.05}});
    return setup;
}

/// The same floor with a rain into the cloud across the periodic edges, where places are scarce, a hole that
/// swallows grains, across an edge too, and a lid above.
GrainSetup come_and_go() {
    GrainSetup setup = on_a_floor();
    GrainSink hole{"hole", {SphereShape{{0.0993, 0.15, 0.03}, 0.02}, false}}, lid{"lid", {}};
    hole.interval = 7;
    hole.begin = 0.0002;
    lid.region = {HalfSpace{{0, 0, 0.075}, {0, 0, -1}}, false};
    GrainSource rain{.name = "rain",
                     .body = 0,
                     .density = 2500,
                     .region = BoxShape{{-0.01, 0.1, 0.05}, {0.05, 0.22, 0.1}}};
    rain.sizes.least = 0.002;
    rain.sizes.greatest = 0.006;
    rain.velocity = {0, 0.3, -1};
    rain.rate = 1e5;
    rain.interval = 5;
    rain.tries = 3;
    setup.flow = {{hole, lid}, {rain}, 7};
    return setup;
}

/// The same rain from before time 0 on, until grains balance somewhat and the floor begins to swing.
GrainSetup settle_first() {
    GrainSetup setup = come_and_go();
    setup.flow.sinks.pop_back();
    setup.flow.sources[0].begin = -0.1;
    setup.flow.sources[0].total = 40;
    setup.settling =
        GrainSettling{.imbalance = 30, .lasting = 2, .interval = 10, .longest = 0.1, .damping = 0.01};
    return setup;
}

/// In a turning drum through which a sheet of triangles is drawn up.
GrainSetup in_a_drum() {
    GrainSetup setup = rolling_setup();
    const dem::Vector3<> middle{0.046, 0.046, 0.035}, along{0, 1, 0};
    const double outer = 0.0615, half = 0.0515;
    dem::Wall drum{
        "drum",
        0,
        dem::RevolvedShape(middle, along, {{0, -half}, {outer, -half}, {outer, half}, {0, half}}, 0.5),
        {}};
    drum.motion.centre = middle;
    drum.motion.axis = along;
    drum.motion.angular_velocity = 20;
    dem::TriangleMesh folded;
    for (const double y : {-0.02, 0.045, 0.11})
        for (const double x : {0.02, 0.046, 0.07})
            folded.vertices.push_back({x, y, x == 0.046 ? 0.0005 : -0.001});
    for (const std::uint32_t corner : {0U, 1U, 3U, 4U}) {
        folded.triangles.push_back({corner, corner + 1, corner + 3});
        folded.triangles.push_back({corner + 1, corner + 4, corner + 3});
    }
    dem::Wall sheet{"sheet", 0, std::make_shared<const dem::TriangleSurface>(folded, 0.1, 0.006), {}};
    sheet.motion.velocity = {0, 0, 3};
    setup.walls = {drum, sheet};
    return setup;
}

/// The rain of come_and_go() into that drum, and a hole where its sheet is drawn through.
GrainSetup come_and_go_in_a_drum() {
    GrainSetup setup = in_a_drum();
    setup.flow = come_and_go().flow;
    setup.flow.sinks.pop_back();
    setup.flow.sinks[0].region = {SphereShape{{0.046, 0.046, 0.004}, 0.012}, false};
    setup.flow.sources[0].region = BoxShape{{0.02, 0.01, 0.05}, {0.07, 0.08, 0.085}};
    return setup;
}

/// The first, with clumps of three spheres of two sizes in place of spheres.
GrainSetup clumps_on_a_floor() {
    GrainSetup setup = on_a_floor();
    const std::vector<dem::Vector3<>> centres{{-0.0024, 0, 0}, {0.0024, 0.0005, 0}, {0, 0.0024, 0.001}};
    const std::vector<double> radii{0.0031, 0.0031, 0.0026};
    setup.clumps = {{std::make_shared<const dem::ClumpShape>(dem::clump_shape(centres, radii, 64)), 0, 2500}};
    return setup;
}

ParticleSet spheres(const Communicator& comm, const GrainSetup&) { return grain_set(comm, cloud()); }

ParticleSet many_sizes(const Communicator& comm, const GrainSetup&) { return grain_set(comm, mixture()); }

ParticleSet clumps(const Communicator& comm, const GrainSetup& setup) {
    std::vector<dem::ClumpState> states;
    for (const GrainState& grain : cloud()) {
        const double half = norm(grain.position) * 400;
        states.push_back({grain.position,
                          grain.velocity,
                          {std::cos(half), {0, 0.8 * std::sin(half), 0.6 * std::sin(half)}},
                          1e-10 * grain.angular_velocity});
    }
    return clump_set(comm, setup, states);
}

/// Sheared for ever: the images across y move two diameters during the run, half a layer of grains crosses.
GrainSetup sheared() {
    GrainSetup setup = rolling_setup();
    setup.box = {3,
                 {-0.003, -0.0003, 0.0013},
                 {0.0993, 0.1016, 0.0731},
                 {Boundary::periodic, Boundary::periodic, Boundary::periodic},
                 80};
    return setup;
}

std::uint64_t hash_of(const Communicator& comm, GrainSimulation& run) {
    const ParticleSet contacts = run.save();
    const std::uint64_t hash = state_hash(comm, run.grains()) * 31 + state_hash(comm, contacts);
    return run.setup().bonds.empty() ? hash : hash * 31 + state_hash(comm, run.saved_bonds());
}

struct Tested {
    const char* name;
    GrainSetup (*setup)();
    ParticleSet (*grains)(const Communicator&, const GrainSetup&);
};

struct How {
    PartitionMethod partition = PartitionMethod::metis;
    int rebalance_interval = 10;
    double skin = 0.0005;
};

GrainSimulation prepared(const Communicator& comm, GrainSetup setup, const How& how, ParticleSet grains) {
    setup.partition = how.partition;
    setup.rebalance_interval = how.rebalance_interval;
    setup.skin = how.skin;
    return {comm, setup, std::move(grains)};
}

GrainSimulation prepared(const Communicator& comm, const Tested& tested, const How& how) {
    const GrainSetup setup = tested.setup();
    return prepared(comm, setup, how, tested.grains(comm, setup));
}

std::uint64_t hash_after(const Communicator& comm, const Tested& tested, const How& how) {
    GrainSimulation run = prepared(comm, tested, how);
    run.start();
    for (int k = 0; k < steps; ++k) run.step();
    return hash_of(comm, run);
}

class GrainsSameBits : public testing::TestWithParam<Tested> {
  protected:
    void SetUp() override {
        const Communicator alone(MPI_COMM_SELF);
        serial_hash_ = hash_after(alone, GetParam(), {});
    }
    std::uint64_t serial_hash_ = 0;
};

TEST_P(GrainsSameBits, RunDoesSomething) {
    const Communicator alone(MPI_COMM_SELF);
    GrainSimulation run = prepared(alone, GetParam(), {});
    run.start();
    std::vector<bool> pressed(run.setup().walls.size());
    for (int k = 0; k < steps; ++k) {
        run.step();
        const auto forces = run.totals().wall_forces;
        for (std::size_t w = 0; w < forces.size(); ++w) pressed[w] = pressed[w] || forces[w][2] != 0;
    }
    const GrainTotals totals = run.totals();
    const bool bonded = !run.setup().bonds.empty();
    EXPECT_GT(totals.contacts, bonded ? 5U : 100U);
    EXPECT_EQ(totals.bonds > 300, bonded);
    EXPECT_EQ(totals.broken_bonds > 300, bonded);
    EXPECT_TRUE(totals.wall_contacts > 10U || run.setup().walls.empty());
    EXPECT_GT(run.list_count(), 10U);
    for (std::size_t w = 0; w < pressed.size(); ++w) EXPECT_TRUE(pressed[w]) << run.setup().walls[w].name;
    EXPECT_EQ(hash_of(alone, run), serial_hash_) << "two equal runs differ";
}

TEST_P(GrainsSameBits, WhoeverOwnsWhat) {
    const Communicator world(MPI_COMM_WORLD);
    constexpr How hows[] = {{PartitionMethod::metis, 1, 0.0005},    {PartitionMethod::metis, 0, 0.0002},
                            {PartitionMethod::cheapest, 1, 0.0005}, {PartitionMethod::bisection, 1, 0.001},
                            {PartitionMethod::slabs, 0, 0.0005},    {PartitionMethod::scrambled, 1, 0.002}};
    const bool bonded = !GetParam().setup().bonds.empty();  // bonds that break make lists anew: dear
    for (const How& how : hows) {
        if (bonded && how.partition != PartitionMethod::cheapest &&
            how.partition != PartitionMethod::scrambled)
            continue;
        EXPECT_EQ(hash_after(world, GetParam(), how), serial_hash_)
            << "method " << static_cast<int>(how.partition) << ", skin " << how.skin;
    }
}

TEST_P(GrainsSameBits, AfterInterruption) {
    const Communicator world(MPI_COMM_WORLD);
    const GrainSetup setup = GetParam().setup();
    for (const int stop : {1, 101}) {
        GrainSimulation first = prepared(world, GetParam(), {});
        first.start();
        for (int k = 0; k < stop; ++k) first.step();
        const ParticleSet contacts = first.save();
        std::map<std::string, double> numbers;
        first.save_numbers(numbers);
        const GatheredState saved_grains = gather_state(world, first.grains()),
                            saved_contacts = gather_state(world, contacts);
        EXPECT_TRUE(stop == 1 || saved_contacts.ids.size() > 30);
        const bool bonded = !first.setup().bonds.empty();
        GatheredState saved_bonds;
        if (bonded) saved_bonds = gather_state(world, first.saved_bonds());
        // Each rank takes an equal share in order of id, as from a checkpoint.
        const auto share = [&](const GatheredState& state) {
            return [&, total = state.ids.size()](std::size_t k) {
                return k * static_cast<std::size_t>(world.size()) / total ==
                       static_cast<std::size_t>(world.rank());
            };
        };
        ParticleSet grains("grains", 3);
        GrainSimulation::add_fields(grains, setup);
        if (bonded) grains.add(field::broken_bonds);
        fill(grains, saved_grains, share(saved_grains));
        ParticleSet read = dem::empty_contacts(3, GrainSimulation::history_fields(setup));
        fill(read, saved_contacts, share(saved_contacts));
        ParticleSet read_bonds = dem::empty_pairs("bonds", 3, dem::BondList::fields());
        if (bonded) fill(read_bonds, saved_bonds, share(saved_bonds));
        GrainSimulation second =
            prepared(world, setup, {PartitionMethod::bisection, 5, 0.0007}, std::move(grains));
        second.resume(first.time(), first.step_count(), numbers, read, bonded ? &read_bonds : nullptr);
        for (int k = stop; k < steps; ++k) second.step();
        EXPECT_EQ(hash_of(world, second), serial_hash_) << "stopped at step " << stop;
        // Saving must not have changed the run that was saved either.
        for (int k = stop; k < steps; ++k) first.step();
        EXPECT_EQ(hash_of(world, first), serial_hash_) << "saved at step " << stop;
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, GrainsSameBits,
                         testing::Values(Tested{"SpheresOnAFloor", on_a_floor, spheres},
                                         Tested{"MixtureOnAFloor", on_a_floor, many_sizes},
                                         Tested{"SpheresInADrum", in_a_drum, spheres},
                                         Tested{"StickyOnAFloor", sticky_on_a_floor, spheres},
                                         Tested{"BondedOnAFloor", bonded_on_a_floor, spheres},
                                         Tested{"ClumpsOnAFloor", clumps_on_a_floor, clumps},
                                         Tested{"Sheared", sheared, spheres},
                                         Tested{"ComeAndGo", come_and_go, spheres},
                                         Tested{"ComeAndGoInADrum", come_and_go_in_a_drum, spheres},
                                         Tested{"SettleFirst", settle_first, spheres}),
                         [](const auto& tested) { return tested.param.name; });

TEST(GrainFlow, LedgerHoldsWhatCameAndWent) {
    const Communicator world(MPI_COMM_WORLD);
    GrainSimulation run = prepared(world, {"", come_and_go, spheres}, {});
    run.start();
    for (int k = 0; k < steps; ++k) run.step();
    const GrainFlow::Came& rain = run.flow().came()[0];
    const auto gone = run.flow().passed();
    EXPECT_GT(gone[0].count, 10U);
    EXPECT_GT(gone[1].count, 20U);
    EXPECT_GT(rain.count, 50U);
    EXPECT_GT(rain.missed, 5U);
    EXPECT_EQ(rain.count + rain.missed, rain.attempts);
    EXPECT_EQ(run.total_grains(), 700 + rain.count - gone[0].count - gone[1].count);
    EXPECT_EQ(run.take_notes().size(), 1U) << "that the source is full is said once";
    double first = 0;
    for (const GrainState& grain : cloud()) first += mass_of(grain);
    EXPECT_NEAR(run.totals().mass, first + rain.mass - gone[0].mass - gone[1].mass, 1e-12 * first)
        << "masses of events, rounded once each";
}

TEST(GrainFlow, TheDrumLosesAndGainsGrains) {
    const Communicator world(MPI_COMM_WORLD);
    GrainSimulation run = prepared(world, {"", come_and_go_in_a_drum, spheres}, {});
    run.start();
    for (int k = 0; k < steps; ++k) run.step();
    EXPECT_GT(run.flow().passed()[0].count, 5U);
    EXPECT_GT(run.flow().came()[0].count, 5U);
}

// A shell that fills a fiftieth of the box around it: every grain lies in it all the same.
TEST(GrainFlow, GrainsComeIntoTheirRegionOnly) {
    const Communicator world(MPI_COMM_WORLD);
    GrainSetup setup = grain_setup({glass}, 0.01, 2e-5);
    GrainSource shell{.name = "shell", .body = 0, .density = 2500, .region = SphereShape{{}, 1, 0.97}};
    shell.sizes.least = shell.sizes.greatest = 0.01;
    shell.rate = 1e6;
    shell.total = 200;
    setup.flow = {{}, {shell}, 3};
    GrainSimulation run(world, setup, grain_set(world, {}));
    run.start();
    for (int k = 0; k < 20; ++k) run.step();
    EXPECT_GT(run.flow().came()[0].count, 150U);
    for (std::size_t i = 0; i < run.grains().size(); ++i) {
        double distance2 = 0;
        for (int axis = 0; axis < 3; ++axis)
            distance2 +=
                run.grains().data(field::position, axis)[i] * run.grains().data(field::position, axis)[i];
        EXPECT_GT(std::sqrt(distance2), 0.97 - 1e-3);
        EXPECT_LT(std::sqrt(distance2), 1 + 1e-3);
    }
}

// Time 0 waits for a source that begins later than the grains there are come to rest.
TEST(GrainFlow, SettlingWaitsForSourcesThatBeginLater) {
    const Communicator world(MPI_COMM_WORLD);
    GrainSetup setup = settle_first();
    setup.flow.sources[0].begin = -0.05;
    setup.settling->imbalance = 1e9;  // quiet at once but for the source
    GrainSimulation run = prepared(world, setup, {}, grain_set(world, cloud()));
    run.start();
    while (run.time() < 0) run.step();
    EXPECT_EQ(run.flow().came()[0].count, 40U);
}

TEST(GrainFlow, SettlingEndsAtTimeZeroOrWithAnError) {
    const Communicator world(MPI_COMM_WORLD);
    GrainSimulation run = prepared(world, {"", settle_first, spheres}, {});
    run.start();
    EXPECT_EQ(run.time(), -0.1);
    while (run.time() < 0) run.step();
    EXPECT_EQ(run.time(), 0);
    EXPECT_GT(run.step_count(), 10U);
    EXPECT_LT(run.step_count(), 100U) << "an interruption at step 1 and another at 101 are on either side";
    EXPECT_EQ(run.flow().came()[0].count, 40U);
    GrainSetup strict = settle_first();
    strict.settling->imbalance = 1e-9;
    strict.settling->longest = 0.001;
    GrainSimulation never(world, strict, grain_set(world, cloud()));
    never.start();
    const auto until_zero = [&] {
        while (never.time() < 0) never.step();
    };
    EXPECT_THROW(until_zero(), AgreedError);
}

TEST(GrainFlow, LedgerThatDoesNotAddUpIsRefused) {
    const Communicator world(MPI_COMM_WORLD);
    GrainSimulation run = prepared(world, {"", come_and_go, spheres}, {});
    const std::map<std::string, double> numbers{{"flow.first_count", 701}};
    const ParticleSet none = dem::empty_contacts(3, GrainSimulation::history_fields(come_and_go()));
    EXPECT_THROW(run.resume(0, 0, numbers, none), AgreedError);
}

}  // namespace
}  // namespace talus::test
