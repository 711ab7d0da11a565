#include "src/analysis/remnants.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "io/scene.hpp"
#include "src/setup/scene_setup.hpp"
#include "tests/support/shares.hpp"

/// What gravity holds together, and its shape and spin, of clouds whose answer is known. G = 1.
namespace talus::test {
namespace {

constexpr double spacing = 1;

/// Adds the points of a cubic lattice of spacing 1 about `centre`, turned, for which inside(x) holds before
/// the turn, moving as a rigid body.
template <class Inside>
void add_body(std::vector<Grain>& grains, const Point& half, const Inside& inside, const Point& centre,
              const Point& velocity, const Rotation& turn = {}, const Point& spin = {}) {
    for (double x = -half[0] + 0.5; x < half[0]; ++x)
        for (double y = -half[1] + 0.5; y < half[1]; ++y)
            for (double z = -half[2] + 0.5; z < half[2]; ++z) {
                if (!inside(Point{x, y, z})) continue;
                const Point offset = turn({x, y, z});
                Grain grain;
                grain.id = (grains.size() * 7919) % 1000003;
                grain.position = plus(centre, offset);
                grain.velocity = plus(velocity, cross(spin, offset));
                grain.mass = 2;
                grains.push_back(grain);
            }
}

void add_ball(std::vector<Grain>& grains, double radius, const Point& centre, const Point& velocity) {
    add_body(
        grains, {radius, radius, radius}, [=](const Point& x) { return norm(x) < radius; }, centre, velocity);
}

double mass_of(const std::vector<Grain>& grains) { return 2.0 * static_cast<double>(grains.size()); }

RemnantRules rules_for(std::size_t count, bool particles_bind = false) {
    return {{1.0, count}, particles_bind, {1, {1.5 * spacing}, true}, {spacing}};
}

Remnants remnants_on(const Communicator& comm, const std::vector<Grain>& grains, const RemnantRules& rules,
                     unsigned salt) {
    const ParticleSet share = share_of(grains, 3, comm.rank(), comm.size(), salt);
    return find_remnants(comm, link_particles(comm, Box{}, share, rules.groups), rules);
}

void expect_same_matter(const MatterFigures& a, const MatterFigures& b) {
    EXPECT_EQ(a.particles, b.particles);
    EXPECT_EQ(a.mass, b.mass);
    EXPECT_EQ(a.centre, b.centre);
    EXPECT_EQ(a.velocity, b.velocity);
    EXPECT_EQ(a.angular_momentum, b.angular_momentum);
    EXPECT_EQ(a.mean_damage, b.mean_damage);
    EXPECT_EQ(a.fully_damaged, b.fully_damaged);
}

/// The remnants found by all ranks, after it was made sure that one rank alone finds the same, bit for bit.
Remnants remnants_of(const std::vector<Grain>& grains, const RemnantRules& rules) {
    const Communicator comm(MPI_COMM_WORLD), alone(MPI_COMM_SELF);
    Remnants found = remnants_on(comm, grains, rules, 5);
    const Remnants serial = remnants_on(alone, grains, rules, 9);
    EXPECT_EQ(found.mass, serial.mass);
    EXPECT_EQ(comm.all_sum(static_cast<std::uint64_t>(found.bound.size())), serial.bound.size());
    EXPECT_EQ(found.list.size(), serial.list.size());
    for (std::size_t k = 0; k < std::min(found.list.size(), serial.list.size()); ++k) {
        const Remnant &a = found.list[k], &b = serial.list[k];
        EXPECT_EQ(a.set.seed, b.set.seed);
        EXPECT_EQ(a.set.pieces, b.set.pieces);
        EXPECT_EQ(a.set.rounds, b.set.rounds);
        expect_same_matter(a.bound, b.bound);
        expect_same_matter(a.body, b.body);
        EXPECT_EQ(a.shape.axes, b.shape.axes);
        EXPECT_EQ(a.shape.semi_axes, b.shape.semi_axes);
        EXPECT_EQ(a.shape.extents, b.shape.extents);
        EXPECT_EQ(a.shape.spin, b.shape.spin);
        EXPECT_EQ(a.set.mass, a.bound.mass);  // by units and by particles: sums of small integers
    }
    return found;
}

/// Two spheres are bound up to the speed at which the two-body orbit is a parabola, v^2 = 2 G (m1 + m2) / r.
TEST(Remnants, TwoSpheresAtTheEscapeSpeed) {
    for (const double radius : {4.0, 2.5})  // of the second; equal masses, and not
        for (const double hair : {-1e-9, 1e-9}) {
            std::vector<Grain> first, second;
            const Point offset{11, 5, -3};
            add_ball(first, 4, {}, {});
            add_ball(second, radius, {}, {});
            const double speed =
                std::sqrt(2 * (mass_of(first) + mass_of(second)) / norm(offset)) * (1 + hair);
            std::vector<Grain> both;
            add_ball(both, 4, {1e3, 2e3, 0}, {3, 0, 0});
            add_ball(both, radius, plus({1e3, 2e3, 0}, offset), {3, 0.6 * speed, 0.8 * speed});
            const Remnants found = remnants_of(both, rules_for(2));
            EXPECT_EQ(found.mass, mass_of(both));
            if (hair < 0) {
                ASSERT_EQ(found.list.size(), 1u);
                EXPECT_EQ(found.list[0].set.pieces, 2u);
                EXPECT_EQ(found.list[0].bound.mass, mass_of(both));
                EXPECT_EQ(found.list[0].body.mass, mass_of(first));
            } else {
                ASSERT_EQ(found.list.size(), 2u);
                EXPECT_EQ(found.list[0].bound.mass, mass_of(first));
                EXPECT_EQ(found.list[1].bound.mass, mass_of(second));
            }
        }
}

/// Units by hand, on ranks in turn.
Binding bound_units(const std::vector<BindingUnit>& units, const BindingRules& rules,
                    std::vector<std::size_t>& set_of) {
    const Communicator comm(MPI_COMM_WORLD);
    std::vector<BindingUnit> mine;
    std::vector<std::size_t> places;
    for (std::size_t k = 0; k < units.size(); ++k)
        if (static_cast<int>(k) % comm.size() == comm.rank()) {
            mine.push_back(units[k]);
            places.push_back(k);
        }
    std::vector<Fragment> groups;
    for (const BindingUnit& unit : units)
        groups.push_back({unit.group, 0, 1, unit.mass, unit.centre, unit.velocity});
    std::sort(groups.begin(), groups.end(), [](const Fragment& a, const Fragment& b) {
        return a.mass != b.mass ? a.mass > b.mass : a.label < b.label;
    });
    const Binding binding = find_bound(comm, mine, groups, rules);
    std::vector<std::uint64_t> all(units.size());
    for (std::size_t k = 0; k < mine.size(); ++k) all[places[k]] = binding.set_of[k];
    comm.all_sum(std::span<std::uint64_t>(all));
    set_of.assign(all.begin(), all.end());
    return binding;
}

/// The third is too fast for the first alone (v^2 r < 2 G (M + m)), not for the first two.
TEST(Binding, ChainNeedsASecondRound) {
    const double between = std::sqrt(2 * 1.26 / 10);
    const std::vector<BindingUnit> units = {
        {40, 0.01, {0, 10, 0}, {between, 0, 0}}, {7, 1, {}, {}}, {9, 0.5, {1, 0, 0}, {}}};
    std::vector<std::size_t> set_of;
    const Binding binding = bound_units(units, {1, 2}, set_of);
    ASSERT_EQ(binding.sets.size(), 1u);
    EXPECT_EQ(binding.sets[0].seed, 7u);
    EXPECT_EQ(binding.sets[0].pieces, 3u);
    EXPECT_EQ(binding.sets[0].rounds, 3);  // the second joins, the third joins, nothing changes
    EXPECT_EQ(binding.sets[0].unsettled, 0u);
    EXPECT_EQ(set_of, (std::vector<std::size_t>{0, 0, 0}));

    const Binding stopped = bound_units(units, {1, 2, 1}, set_of);
    EXPECT_EQ(stopped.sets[0].unsettled, 1u);  // said, when rounds run out
    EXPECT_EQ(stopped.sets[0].pieces, 2u);
}

/// The third joins the first at rest, and leaves when the fast second has set the centre of mass moving.
TEST(Binding, JoinedAndDroppedAgain) {
    const std::vector<BindingUnit> units = {
        {1, 1, {}, {}}, {2, 0.9, {1, 0, 0}, {1.5, 0, 0}}, {3, 1e-3, {-3, 0, 0}, {-0.7, 0, 0}}};
    std::vector<std::size_t> set_of;
    const Binding binding = bound_units(units, {1, 3}, set_of);
    ASSERT_EQ(binding.sets.size(), 2u);
    EXPECT_EQ(binding.sets[0].rounds, 3);
    EXPECT_EQ(set_of, (std::vector<std::size_t>{0, 0, 1}));
}

/// Seeds are taken by mass, equal ones by label; none is taken twice, and no more than asked for.
TEST(Binding, SecondLargestAndTies) {
    const std::vector<BindingUnit> units = {{5, 1, {}, {}},
                                            {3, 1, {1e6, 0, 0}, {}},
                                            {8, 0.5, {1e6, 1, 0}, {}},
                                            {2, 0.1, {0, 1e6, 0}, {}},
                                            {1, 0.1, {1e7, 1e6, 0}, {}}};
    std::vector<Point> fast = {{}, {1e3, 0, 0}, {1e3, 0, 0}, {0, 1e3, 0}, {0, 0, 1e3}};
    std::vector<BindingUnit> moving = units;
    for (std::size_t k = 0; k < units.size(); ++k) moving[k].velocity = fast[k];
    std::vector<std::size_t> set_of;
    const Binding two = bound_units(moving, {1, 2}, set_of);
    ASSERT_EQ(two.sets.size(), 2u);
    EXPECT_EQ(two.sets[0].seed, 3u);
    EXPECT_EQ(two.sets[0].mass, 1.5);
    EXPECT_EQ(two.sets[1].seed, 5u);
    EXPECT_EQ(set_of, (std::vector<std::size_t>{1, 0, 0, 2, 2}));
    const Binding all = bound_units(moving, {1, 10}, set_of);
    ASSERT_EQ(all.sets.size(), 4u);
    EXPECT_EQ(all.sets[2].seed, 1u);
    EXPECT_EQ(all.sets[3].seed, 2u);
}

/// A cap that is just lifting off at 1.5 times the escape speed still touches the ball: bound as one group,
/// lost particle by particle.
TEST(Remnants, CapThatLiftsOff) {
    std::vector<Grain> grains;
    add_ball(grains, 8, {}, {});
    std::uint64_t cap = 0;
    for (Grain& grain : grains)
        if (grain.position[2] > 7) {
            grain.velocity[2] = 1.5 * std::sqrt(2 * mass_of(grains) / 7.5);
            ++cap;
        }
    ASSERT_GT(cap, 20u);
    const Remnants as_group = remnants_of(grains, rules_for(1));
    EXPECT_EQ(as_group.list.at(0).bound.particles, grains.size());
    const Remnants apart = remnants_of(grains, rules_for(1, true));
    EXPECT_EQ(apart.list.at(0).bound.particles, grains.size() - cap);
    EXPECT_EQ(apart.list.at(0).bound.velocity[2], 0);
}

const Rotation askew = rotation_about(0, 0.4).then(rotation_about(1, -1.1)).then(rotation_about(2, 2.3));

/// A brick of cubes: its second moments L^2/12 and its length along each axis are exact, up to rounding of
/// coordinates around 100.
TEST(Remnants, BrickIsExact) {
    std::vector<Grain> grains;
    const Point spin{0.3, -0.2, 0.5}, velocity{1, 2, 3};
    add_body(
        grains, {6, 4, 2.5}, [](const Point&) { return true; }, {100, 50, 0}, velocity, askew, spin);
    ASSERT_EQ(grains.size(), 480u);
    for (std::size_t k = 0; k < 120; ++k) grains[k].damage = k < 48 ? 1 : 0.5;
    const Remnants found = remnants_of(grains, rules_for(1));
    ASSERT_EQ(found.list.size(), 1u);
    const Remnant& brick = found.list[0];
    const Point lengths{12, 8, 5};
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(brick.shape.semi_axes[k], lengths[k] * std::sqrt(5.0 / 12), 1e-11);
        EXPECT_NEAR(brick.shape.extents[k], lengths[k], 1e-11);
        EXPECT_NEAR(brick.shape.spin[k], spin[k], 1e-12);
        EXPECT_NEAR(brick.bound.velocity[k], velocity[k], 1e-12);
        Point unit{};
        unit[k] = 1;
        EXPECT_NEAR(std::abs(dot(brick.shape.axes[k], askew(unit))), 1, 1e-12);
    }
    EXPECT_NEAR(*brick.body.fully_damaged, 0.1, 1e-15);
    EXPECT_NEAR(*brick.body.mean_damage, 0.1 + 0.5 * 0.15, 1e-15);
    // An ellipsoid of the brick's inertia is larger than the brick, by (4 pi / 3) (5/12)^(3/2).
    EXPECT_NEAR(brick.shape.density, 2 / (4 * std::numbers::pi / 3 * std::pow(5.0 / 12, 1.5)), 1e-10);
}

/// An ellipsoid's own axes come back from its inertia. Layers of a lattice are a midpoint rule for the
/// moments along all axes, of relative error (spacing / semi-axis)^2; the shortest, with the fewest layers,
/// sets it, of the density for each of the three axes. Ends are known to half a spacing each; the spin is
/// exact.
TEST(Remnants, EllipsoidAndItsSpin) {
    for (const double scale : {1.0, 2.0}) {
        std::vector<Grain> grains;
        const Point semi = times(scale, {12, 8.5, 6}), spin{0.01, 0.02, -0.03};
        const auto inside = [&](const Point& x) {
            return std::hypot(x[0] / semi[0], x[1] / semi[1], x[2] / semi[2]) < 1;
        };
        add_body(grains, times(scale, {13, 9, 7}), inside, {7, 8, 9}, {0.5, 0, 0}, askew, spin);
        const Remnants found = remnants_of(grains, rules_for(2));
        ASSERT_EQ(found.list.size(), 1u);
        const BodyFigures& shape = found.list[0].shape;
        const double relative = spacing * spacing / (semi[2] * semi[2]);
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_NEAR(shape.semi_axes[k], semi[k], relative * semi[k]);
            EXPECT_NEAR(shape.extents[k], 2 * semi[k], spacing);
            EXPECT_NEAR(shape.spin[k], spin[k], 1e-13);
        }
        EXPECT_NEAR(shape.density, 2, 3 * relative * 2);
    }
}

/// A body, a satellite, dust around both, and escaping dust, on any number of ranks.
TEST(Remnants, RandomSwarmHasTheSameBits) {
    std::vector<Grain> grains;
    add_ball(grains, 6, {}, {0.1, 0, 0});
    add_ball(grains, 3, {15, 2, 0}, {0, 3, 2});
    add_ball(grains, 4, {-40, 0, 9}, {-30, 10, 0});
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (int k = 0; k < 1200; ++k) {
        Grain dust;
        dust.id = 2000000 + grains.size();
        for (std::size_t a = 0; a < 3; ++a) {
            dust.position[a] = 20 * normal(random);
            dust.velocity[a] = 9 * normal(random);
        }
        dust.mass = 2;
        dust.damage = std::abs(normal(random)) > 1 ? 1 : 0.3;
        grains.push_back(dust);
    }
    for (const bool particles_bind : {false, true}) {
        const Remnants found = remnants_of(grains, rules_for(3, particles_bind));
        ASSERT_EQ(found.list.size(), 3u);
        EXPECT_GT(found.list[0].set.pieces, 100u);
        EXPECT_LT(found.list[0].bound.mass, 0.9 * found.mass);
        EXPECT_GE(found.list[0].bound.mass, found.list[1].bound.mass);
        EXPECT_GE(found.list[1].bound.mass, found.list[2].bound.mass);
    }
}

TEST(Remnants, NothingAndAlone) {
    EXPECT_TRUE(remnants_of({}, rules_for(2)).list.empty());
    const Remnants one = remnants_of({Grain{.id = 4, .position = {1, 2, 3}}}, rules_for(2));
    ASSERT_EQ(one.list.size(), 1u);
    EXPECT_EQ(one.list[0].body.particles, 1u);
    EXPECT_EQ(norm(one.list[0].shape.spin), 0);
    EXPECT_NEAR(one.list[0].shape.extents[2], spacing, 1e-15);
}

AnalysisPlan plan_of(const std::string& rest, bool cracks) {
    const Communicator comm(MPI_COMM_WORLD);
    const std::string text = R"(
[materials.rock]
density = 2700
shear_modulus = 1e10
equation_of_state = { kind = "linear", sound_speed = 3000 })" +
                             std::string(cracks ? "\nfracture = { weibull_k = 4e35, weibull_m = 9 }" : "") +
                             R"(
[[body]]
material = "rock"
shape = "sphere"
radius = 1
spacing = 0.5
[run]
end_time = 1
)" + rest;
    return read_scene(comm, Scene::parse(text, "s.toml")).analysis;
}
std::string fault_of(const std::string& rest, bool cracks) {
    try {
        plan_of(rest, cracks);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

TEST(AnalysisTable, DefaultsFollowTheScene) {
    EXPECT_FALSE(plan_of("", true).asks_for_anything());
    const AnalysisPlan cracking = plan_of("[analysis]\n", true);
    EXPECT_FALSE(cracking.rules.all_matter);
    EXPECT_FALSE(cracking.remnants);
    EXPECT_TRUE(plan_of("[analysis]\n", false).rules.all_matter);
    const AnalysisPlan heavy = plan_of("[analysis]\nfragments = false\n[gravity]\nconstant = 3\n", true);
    EXPECT_FALSE(heavy.fragments);
    ASSERT_TRUE(heavy.remnants);
    EXPECT_EQ(heavy.remnants->binding.constant, 3);
    EXPECT_EQ(heavy.remnants->binding.count, 2u);
    EXPECT_TRUE(plan_of("[analysis]\n[gravity]\n", true).rules.all_matter);
    const AnalysisPlan light = plan_of("[analysis]\nremnants = true\nremnant_count = 4\n", true);
    EXPECT_EQ(light.remnants->binding.constant, newton_constant);
    EXPECT_EQ(light.remnants->binding.count, 4u);
    EXPECT_EQ(light.remnants->groups.linking_length, std::vector<double>{0.75});
}

TEST(AnalysisTable, WrongOnesAreNamed) {
    EXPECT_NE(
        fault_of("[analysis]\nlink = \"undamaged\"\n", false).find("no body has a material that cracks"),
        std::string::npos);
    const std::string closed = fault_of(
        "[analysis]\nremnants = true\n[box]\nboundaries = [\"periodic\", \"open\", \"open\"]\n"
        "lower = [-4, 0, 0]\nupper = [4, 0, 0]\n",
        true);
    EXPECT_NE(closed.find("all \"open\""), std::string::npos) << closed;
    EXPECT_NE(fault_of("[analysis]\nremnants = true\nremnant_count = 0\n", true).find("remnant_count"),
              std::string::npos);
    EXPECT_NE(fault_of("[analysis]\nremnants = true\nbinding = \"grains\"\n", true).find("particles"),
              std::string::npos);
}

}  // namespace
}  // namespace talus::test
