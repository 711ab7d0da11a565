#include "tests/support/grain_setups.hpp"

#include <cmath>
#include <utility>

namespace talus::test {

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

namespace {

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

}  // namespace

GrainSetup on_a_floor() { return on_a_floor(rolling_setup()); }
GrainSetup sticky_on_a_floor() {
    return on_a_floor(setup_under<dem::LawTable<dem::JohnsonKendallRoberts, dem::ElasticPlasticRolling,
                                                dem::ContactAreaTwisting>>());
}

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

GrainSetup settle_first() {
    GrainSetup setup = come_and_go();
    setup.flow.sinks.pop_back();
    setup.flow.sources[0].begin = -0.1;
    setup.flow.sources[0].total = 40;
    setup.settling =
        GrainSettling{.imbalance = 30, .lasting = 2, .interval = 10, .longest = 0.1, .damping = 0.01};
    return setup;
}

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

GrainSetup come_and_go_in_a_drum() {
    GrainSetup setup = in_a_drum();
    setup.flow = come_and_go().flow;
    setup.flow.sinks.pop_back();
    setup.flow.sinks[0].region = {SphereShape{{0.046, 0.046, 0.004}, 0.012}, false};
    setup.flow.sources[0].region = BoxShape{{0.02, 0.01, 0.05}, {0.07, 0.08, 0.085}};
    return setup;
}

GrainSetup clumps_on_a_floor() {
    GrainSetup setup = on_a_floor();
    const std::vector<dem::Vector3<>> centres{{-0.0024, 0, 0}, {0.0024, 0.0005, 0}, {0, 0.0024, 0.001}};
    const std::vector<double> radii{0.0031, 0.0031, 0.0026};
    setup.clumps = {{std::make_shared<const dem::ClumpShape>(dem::clump_shape(centres, radii, 64)), 0, 2500}};
    return setup;
}

GrainSetup clumps_come_and_go() {
    GrainSetup setup = settle_first();
    const std::vector<dem::Vector3<>> centres{{-0.003, 0, 0}, {0.003, 0, 0}};
    const std::vector<double> radii{0.004, 0.0025};
    setup.clumps = clumps_on_a_floor().clumps;
    setup.clumps.push_back(
        {std::make_shared<const dem::ClumpShape>(dem::clump_shape(centres, radii, 64)), 0, 2500});
    setup.clumps.push_back({nullptr, 0, 2500});
    setup.material = {0, 0, 0};
    setup.held = {0, 0, 0};
    GrainSource rain = setup.flow.sources[0], shower = rain;
    for (GrainSource* one : {&rain, &shower}) {
        one->body = 1;
        one->clump = setup.clumps[1].shape;
        one->turned = one == &rain;
    }
    shower.name = "shower";
    shower.begin = 0;
    shower.total = 1e300;
    shower.rate = 3e4;
    GrainSource drizzle = come_and_go().flow.sources[0];
    drizzle.name = "drizzle";
    drizzle.body = 2;
    drizzle.rate = 2e4;
    setup.flow.sources = {rain, shower, drizzle};
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

GrainSetup sheared() {
    GrainSetup setup = rolling_setup();
    setup.box = {3,
                 {-0.003, -0.0003, 0.0013},
                 {0.0993, 0.1016, 0.0731},
                 {Boundary::periodic, Boundary::periodic, Boundary::periodic},
                 80};
    return setup;
}

GrainSetup clumps_sheared() {
    GrainSetup setup = sheared();
    setup.clumps = clumps_on_a_floor().clumps;
    return setup;
}

}  // namespace talus::test
