#include "src/analysis/fragments.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include "tests/support/shares.hpp"

namespace talus::test {
namespace {

/// Particles of one or two bodies, all of them on every rank.
struct Rubble {
    int dimension = 3;
    Box box;
    std::vector<std::array<double, 3>> position;
    std::vector<double> damage;
    std::vector<std::uint8_t> body;

    void add(const std::array<double, 3>& x, double d = 0, std::uint8_t b = 0) {
        position.push_back(x);
        damage.push_back(d);
        body.push_back(b);
    }
    double mass(std::size_t k) const { return 1 + 0.25 * static_cast<double>(k % 7) + 1e-9 * std::sqrt(k); }
    std::array<double, 3> velocity(std::size_t k) const {
        return {std::sin(static_cast<double>(k)), 0.1 * static_cast<double>(k % 11),
                -3.0 + 1e-7 * std::cbrt(k)};
    }
    static std::uint64_t id(std::size_t k) { return 3 * ((k * 7919) % 1000003) + 5; }  // in no order

    ParticleSet share(int rank, int ranks, unsigned salt) const {
        std::vector<Grain> grains;
        for (std::size_t k = 0; k < position.size(); ++k)
            grains.push_back({id(k), position[k], velocity(k), mass(k), damage[k], body[k]});
        return share_of(grains, dimension, rank, ranks, salt);
    }
};

double distance2(const Rubble& rubble, std::size_t k, std::size_t l) {
    double sum = 0;
    for (int axis = 0; axis < rubble.dimension; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        double d = rubble.position[k][a] - rubble.position[l][a];
        if (rubble.box.boundary[a] == Boundary::periodic)
            d -= rubble.box.length(axis) * std::round(d / rubble.box.length(axis));
        sum += d * d;
    }
    return sum;
}

struct Piece {
    std::vector<std::size_t> members;
    std::uint64_t label = std::numeric_limits<std::uint64_t>::max();
};

/// Every pair looked at, labels swapped until nothing changes: slow and plain.
std::vector<Piece> brute_force(const Rubble& rubble, const FragmentRules& rules) {
    const std::size_t count = rubble.position.size();
    std::vector<std::size_t> piece(count);
    std::iota(piece.begin(), piece.end(), std::size_t{0});
    const auto whole = [&](std::size_t k) {
        return (rules.all_matter || rubble.damage[k] < rules.damage_threshold) &&
               rules.linking_length[rubble.body[k]] > 0;
    };
    for (std::size_t k = 0; k < count; ++k)
        for (std::size_t l = 0; l < k; ++l) {
            const double length =
                std::max(rules.linking_length[rubble.body[k]], rules.linking_length[rubble.body[l]]);
            const bool parted = !rules.all_matter && rubble.body[k] != rubble.body[l];
            if (!whole(k) || !whole(l) || parted || piece[k] == piece[l] ||
                !(distance2(rubble, k, l) < length * length))
                continue;
            const std::size_t from = piece[k], to = piece[l];
            std::replace(piece.begin(), piece.end(), from, to);
        }
    std::map<std::size_t, Piece> pieces;
    for (std::size_t k = 0; k < count; ++k) {
        if (!whole(k)) continue;
        pieces[piece[k]].members.push_back(k);
        pieces[piece[k]].label = std::min(pieces[piece[k]].label, Rubble::id(k));
    }
    std::vector<Piece> list;
    for (auto& [key, p] : pieces) list.push_back(std::move(p));
    return list;
}

void expect_fragments_are_those_of_brute_force(const Rubble& rubble, const FragmentRules& rules) {
    const Communicator comm(MPI_COMM_WORLD), alone(MPI_COMM_SELF);
    const auto found = find_fragments(comm, rubble.box, rubble.share(comm.rank(), comm.size(), 17), rules);
    const auto serial = find_fragments(alone, rubble.box, rubble.share(0, 1, 4), rules);

    ASSERT_EQ(found.size(), serial.size());
    for (std::size_t k = 0; k < found.size(); ++k) {  // bit for bit
        ASSERT_EQ(found[k].label, serial[k].label);
        ASSERT_EQ(found[k].body, serial[k].body);
        ASSERT_EQ(found[k].particles, serial[k].particles);
        ASSERT_EQ(found[k].mass, serial[k].mass);
        ASSERT_EQ(found[k].centre, serial[k].centre);
        ASSERT_EQ(found[k].velocity, serial[k].velocity);
        if (k > 0) {
            ASSERT_GE(found[k - 1].mass, found[k].mass);
        }
    }

    std::map<std::uint64_t, Fragment> by_label;
    for (const Fragment& fragment : found) by_label.emplace(fragment.label, fragment);
    const std::vector<Piece> expected = brute_force(rubble, rules);
    ASSERT_EQ(found.size(), expected.size());
    for (const Piece& piece : expected) {
        ASSERT_TRUE(by_label.contains(piece.label));
        const Fragment& fragment = by_label.at(piece.label);
        EXPECT_EQ(fragment.particles, piece.members.size());
        double mass = 0, centre = 0, velocity = 0;
        std::uint8_t least_body = 255;
        for (const std::size_t k : piece.members) {
            least_body = std::min(least_body, rubble.body[k]);
            mass += rubble.mass(k);
            centre += rubble.mass(k) * rubble.position[k][0];
            velocity += rubble.mass(k) * rubble.velocity(k)[0];
        }
        EXPECT_EQ(fragment.body, least_body);
        EXPECT_NEAR(fragment.mass, mass, 1e-12 * mass);
        EXPECT_NEAR(fragment.centre[0], centre / mass, 1e-10);
        EXPECT_NEAR(fragment.velocity[0], velocity / mass, 1e-10);
    }
}

TEST(Fragments, RandomCloudsAreThoseOfBruteForce) {
    for (int dimension = 1; dimension <= 3; ++dimension)
        for (const bool periodic : {false, true}) {
            SCOPED_TRACE(dimension);
            Rubble rubble;
            rubble.dimension = rubble.box.dimension = dimension;
            for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
                rubble.box.upper[a] = 1;
                if (periodic) rubble.box.boundary[a] = Boundary::periodic;
            }
            std::mt19937 random(static_cast<unsigned>(dimension));
            std::uniform_real_distribution<double> uniform(0, 1);
            for (int k = 0; k < 1500; ++k) {
                const std::array<double, 3> x{uniform(random), uniform(random), uniform(random)};
                const double damage = uniform(random);
                rubble.add(x, damage, static_cast<std::uint8_t>(uniform(random) < 0.2));
            }
            // About the length at which clouds begin to hang together: fragments of every size.
            const double length = std::array{0.004, 0.035, 0.095}[static_cast<std::size_t>(dimension - 1)];
            expect_fragments_are_those_of_brute_force(rubble, {0.8, {length, 1.3 * length}});
            expect_fragments_are_those_of_brute_force(rubble, {0.3, {0, length}});
            expect_fragments_are_those_of_brute_force(rubble, {0.3, {0.6 * length, 0.8 * length}, true});
        }
}

/// Two balls of a lattice that touch in a layer of damaged particles.
TEST(Fragments, DamagedLayerParts) {
    Rubble rubble;
    for (int x = -10; x <= 10; ++x)
        for (int y = -5; y <= 5; ++y)
            for (int z = -5; z <= 5; ++z) {
                const double from_centre = std::abs(x) - 5;
                if (from_centre * from_centre + y * y + z * z > 26) continue;
                rubble.add({double(x), double(y), double(z)}, x == 0 ? 1.0 : 0.2 * (y % 2));
            }
    expect_fragments_are_those_of_brute_force(rubble, {1, {1.5}});
    const Communicator comm(MPI_COMM_WORLD);
    const ParticleSet share = rubble.share(comm.rank(), comm.size(), 1);
    EXPECT_EQ(find_fragments(comm, rubble.box, share, {1, {1.5}}).size(), 2u);
    EXPECT_EQ(find_fragments(comm, rubble.box, share, {1, {2.5}}).size(), 1u);  // reaches over the layer
    EXPECT_EQ(find_fragments(comm, rubble.box, share, {1.1, {1.5}}).size(), 1u);
}

/// A line of particles that winds through space in layers: labels travel along it through every rank, many
/// times.
TEST(Fragments, WindingChainIsOne) {
    Rubble rubble;
    constexpr int rows = 16, length = 60;
    for (int row = 0; row < rows; ++row) {
        const bool back = row % 2 == 1;
        for (int k = 0; k < length; ++k) rubble.add({double(back ? length - 1 - k : k), 3.0 * row, 0});
        const double end = back ? 0 : length - 1;
        for (int k = 1; k < 3 && row + 1 < rows; ++k) rubble.add({end, 3.0 * row + k, 0});
    }
    expect_fragments_are_those_of_brute_force(rubble, {1, {1.2}});
    const Communicator comm(MPI_COMM_WORLD);
    const auto found =
        find_fragments(comm, rubble.box, rubble.share(comm.rank(), comm.size(), 2), {1, {1.2}});
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].particles, rubble.position.size());
}

TEST(Fragments, NoneAmongDustOrNothing) {
    const Communicator comm(MPI_COMM_WORLD);
    Rubble nothing, dust;
    for (int k = 0; k < 50; ++k) dust.add({0.1 * k, 0, 0}, 1);
    for (const Rubble* rubble : {&nothing, &dust})
        EXPECT_TRUE(find_fragments(comm, rubble->box, rubble->share(comm.rank(), comm.size(), 3), {1, {1.0}})
                        .empty());
    Rubble single = dust;
    single.damage[20] = 0.5;
    const auto found =
        find_fragments(comm, single.box, single.share(comm.rank(), comm.size(), 3), {1, {1.0}});
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].label, Rubble::id(20));
}

}  // namespace
}  // namespace talus::test
