#include "src/analysis/hand_off.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "io/checkpoint.hpp"
#include "random_particles.hpp"
#include "tests/support/gathered.hpp"
#include "tests/support/shares.hpp"

namespace talus::test {
namespace {

constexpr double density = 2000;

/// Clumps of a lattice with a spin and a speed of their own, half of one body and half of another, in dust,
/// far from the origin.
std::vector<Grain> broken_body() {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<Grain> rubble;
    const auto add = [&](const Point& x, const Point& v, double damage, bool second) {
        const std::uint64_t id = (rubble.size() * 7919) % 1000003;
        rubble.push_back(
            {id, x, v, density * (1 + 0.2 * uniform(random)), damage, static_cast<std::uint8_t>(second)});
    };
    for (int clump = 0; clump < 12; ++clump) {
        const Point middle{1e4 + 60 * uniform(random), 60 * uniform(random), 30.0 * clump},
            speed{100 * uniform(random), 7, -40}, spin{uniform(random), uniform(random), uniform(random)};
        const int size = 1 + clump / 3;
        for (int x = -size; x <= size; ++x)
            for (int y = -1; y <= 1; ++y)
                for (int z = -1; z <= 1; ++z) {
                    const Point arm{double(x), double(y), double(z)};
                    add(plus(middle, arm), plus(speed, cross(spin, arm)), 0.3, x > 0);
                }
    }
    for (int k = 0; k < 200; ++k)
        add({1e4 + 80 * uniform(random), 80 * uniform(random), 200 + 180 * uniform(random)},
            {300 * uniform(random), 300 * uniform(random), 20}, 1, k % 2 == 0);
    return rubble;
}

ParticleSet share(const Communicator& comm, const std::vector<Grain>& rubble, unsigned salt) {
    ParticleSet particles = share_of(rubble, 3, comm.rank(), comm.size(), salt);
    particles.add(field::internal_energy);
    for (double& u : particles.own(field::internal_energy)) u = 3;
    return particles;
}

HandOffPlan plan_of(std::optional<FragmentRules> groups) {
    return {.at = 0, .groups = std::move(groups), .filling = 1, .density = {density, density}};
}

Box open_box() {
    Box box;
    box.dimension = 3;
    return box;
}

std::vector<std::optional<FragmentRules>> all_groups() {
    return {std::nullopt, FragmentRules{1, {1.2, 1.2}}, FragmentRules{1, {1.2, 1.2}, true}};
}

// Rounding of a sum over some thousands of products; each quantity in units of the sum of its sizes.
constexpr double rounding = 1e-13;

TEST(HandOff, KeepsMassMomentumAndAngularMomentum) {
    const Communicator comm(MPI_COMM_WORLD);
    const std::vector<Grain> rubble = broken_body();
    const ParticleSet particles = share(comm, rubble, 5);
    for (const auto& groups : all_groups()) {
        const HandOff found = hand_off(comm, plan_of(groups), open_box(), particles);
        EXPECT_EQ(found.particles, rubble.size());
        // The state as it was, summed plainly, not by the code under test.
        double mass = 0;
        Point momentum{}, turning{};
        for (const Grain& one : rubble) {
            mass += one.mass;
            momentum = plus(momentum, times(one.mass, one.velocity));
            turning = plus(turning, times(one.mass, cross(one.position, one.velocity)));
        }
        const auto all = [&](const Field<double>& field, int axis) {
            return comm.all_gather(std::as_const(found.grains).own(field, axis));
        };
        const auto grain_mass = all(field::mass, 0), radius = all(field::radius, 0),
                   inertia = all(field::moment_of_inertia, 0);
        std::array<std::vector<double>, 3> x, v, spin;
        for (int a = 0; a < 3; ++a) {
            x[static_cast<std::size_t>(a)] = all(field::position, a);
            v[static_cast<std::size_t>(a)] = all(field::velocity, a);
            spin[static_cast<std::size_t>(a)] = all(field::angular_velocity, a);
        }
        double new_mass = 0, volume = 0;
        Point new_momentum{}, new_turning{};
        for (std::size_t k = 0; k < grain_mass.size(); ++k) {
            const Point at{x[0][k], x[1][k], x[2][k]}, speed{v[0][k], v[1][k], v[2][k]},
                rate{spin[0][k], spin[1][k], spin[2][k]};
            new_mass += grain_mass[k];
            new_momentum = plus(new_momentum, times(grain_mass[k], speed));
            new_turning =
                plus(new_turning, plus(times(grain_mass[k], cross(at, speed)), times(inertia[k], rate)));
            volume += 4 * std::numbers::pi / 3 * radius[k] * radius[k] * radius[k];
            EXPECT_NEAR(inertia[k], 0.4 * grain_mass[k] * radius[k] * radius[k], 1e-14 * inertia[k]);
        }
        EXPECT_NEAR(new_mass, mass, rounding * mass);
        EXPECT_NEAR(volume, mass / density, rounding * volume);
        EXPECT_LT(norm(minus(new_momentum, momentum)), rounding * found.before.momentum_size);
        EXPECT_LT(norm(minus(new_turning, turning)), rounding * found.before.turning_size);
        // Spins are a part that can be missed.
        if (groups) {
            double of_spin = 0;
            for (std::size_t k = 0; k < inertia.size(); ++k)
                of_spin += inertia[k] * std::hypot(spin[0][k], spin[1][k], spin[2][k]);
            EXPECT_GT(of_spin, 1e6 * rounding * found.before.turning_size);
        }
        EXPECT_NEAR(found.internal_energy, 3 * mass, 1e-12 * mass);
    }
}

TEST(HandOff, MakesAGrainOfEachGroupWithTheSameBitsOnAnyNumberOfRanks) {
    const Communicator comm(MPI_COMM_WORLD), alone(MPI_COMM_SELF);
    const std::vector<Grain> rubble = broken_body();
    for (const auto& groups : all_groups()) {
        const HandOff found = hand_off(comm, plan_of(groups), open_box(), share(comm, rubble, 17)),
                      serial = hand_off(alone, plan_of(groups), open_box(), share(alone, rubble, 3));
        EXPECT_EQ(gather_state(comm, found.grains), gather_state(alone, serial.grains));
        EXPECT_EQ(found.overlaps.pairs, serial.overlaps.pairs);
        EXPECT_EQ(found.overlaps.deepest, serial.overlaps.deepest);
        EXPECT_EQ(found.overlaps.share, serial.overlaps.share);
        EXPECT_EQ(describe(found), describe(serial));
        const std::uint64_t grains = comm.all_sum(static_cast<std::uint64_t>(found.grains.size()));
        EXPECT_EQ(grains, found.fragments + found.singles);
        if (!groups) {
            EXPECT_EQ(found.fragments, 0u);
            EXPECT_EQ(found.singles, rubble.size());
        } else {
            const auto pieces = find_fragments(comm, open_box(), share(comm, rubble, 17), *groups);
            const bool keeps_dust = !groups->all_matter;
            EXPECT_EQ(grains, pieces.size() + (keeps_dust ? 200u : 0u));
        }
    }
}

// Grains of a rod: rotation as of a solid body has the angular momentum of the rod, which a sphere of its
// mass turns faster for.
TEST(HandOff, GivesASphereTheAngularMomentumOfARod) {
    const Communicator comm(MPI_COMM_WORLD);
    std::vector<Grain> rod;
    const Point spin{0, 0, 0.01};
    for (int k = -10; k <= 10; ++k) {
        const Point arm{double(k), 0, 0};
        rod.push_back({static_cast<std::uint64_t>(k + 10), arm, cross(spin, arm), density, 0, 0});
    }
    const HandOff found =
        hand_off(comm, plan_of(FragmentRules{1, {1.2, 1.2}}), open_box(), share(comm, rod, 2));
    const auto rate = comm.all_gather(std::as_const(found.grains).own(field::angular_velocity, 2));
    ASSERT_EQ(rate.size(), 1u);
    const double radius = std::cbrt(3 * 21 / (4 * std::numbers::pi)), arms2 = 2 * 385;  // 1^2 + ... + 10^2
    EXPECT_NEAR(rate[0], spin[2] * arms2 / (21 * 0.4 * radius * radius), 1e-14);
    EXPECT_EQ(found.overlaps.pairs, 0u);
}

TEST(HandOff, FindsEveryOverlap) {
    const Communicator comm(MPI_COMM_WORLD);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(0, 1);
    ParticleSet mine("grains", 3);
    mine.add(field::radius);
    std::vector<std::array<double, 4>> spheres;
    for (int k = 0; k < 600; ++k)  // a few are larger than three times the least
        spheres.push_back({uniform(random), uniform(random), uniform(random),
                           0.01 * (1 + 1.5 * uniform(random)) * (k % 40 == 0 ? 12 : 1)});
    for (std::size_t k = 0; k < spheres.size(); ++k) {
        if (k % static_cast<std::size_t>(comm.size()) != static_cast<std::size_t>(comm.rank())) continue;
        const std::size_t i = mine.size();
        mine.resize(i + 1);
        mine.data(field::id)[i] = k;
        for (int a = 0; a < 3; ++a)
            mine.data(field::position, a)[i] = spheres[k][static_cast<std::size_t>(a)];
        mine.data(field::radius)[i] = spheres[k][3];
    }
    Overlaps expected;
    std::uint64_t of_different = 0;
    for (std::size_t k = 0; k < spheres.size(); ++k)
        for (std::size_t l = 0; l < k; ++l) {
            const auto &a = spheres[k], &b = spheres[l];
            const double overlap = a[3] + b[3] - std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
            if (!(overlap > 0)) continue;
            ++expected.pairs;
            of_different += (k + l) % 2;
            expected.deepest = std::max(expected.deepest, overlap);
            expected.share = std::max(expected.share, overlap / std::min(a[3], b[3]));
        }
    const Overlaps found = overlaps_of(comm, mine);
    EXPECT_GT(expected.pairs, 300u);
    EXPECT_EQ(found.pairs, expected.pairs);
    EXPECT_NEAR(found.deepest, expected.deepest, 1e-14);
    EXPECT_NEAR(found.share, expected.share, 1e-12);
    mine.add(field::body);
    for (std::size_t i = 0; i < mine.size(); ++i)
        mine.data(field::body)[i] = static_cast<std::uint8_t>(mine.data(field::id)[i] % 2);
    EXPECT_EQ(overlaps_of(comm, mine).pairs, expected.pairs);
    EXPECT_EQ(overlaps_of(comm, mine, Between::different_bodies).pairs, of_different);
    mine.resize(0);
    EXPECT_EQ(overlaps_of(comm, mine).pairs, 0u);
}

TEST(HandOff, GrainsAreReadBackFromTheirFile) {
    const Communicator comm(MPI_COMM_WORLD);
    const testing::SharedFolder folder(comm);
    const HandOff made =
        hand_off(comm, plan_of(FragmentRules{1, {1.2, 1.2}}), open_box(), share(comm, broken_body(), 8));
    write_particle_sets(comm, folder.path / "grains.h5", testing::some_state(7), {&made.grains});
    ParticleSet read = made.grains;
    read.resize(0);
    EXPECT_EQ(read_checkpoint(comm, folder.path / "grains.h5", {&read}).time, testing::some_state(7).time);
    EXPECT_EQ(gather_state(comm, read), gather_state(comm, made.grains));
}

}  // namespace
}  // namespace talus::test
