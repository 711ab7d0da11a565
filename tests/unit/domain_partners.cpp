#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "domain/partners.hpp"
#include "domain/random.hpp"
#include "tests/support/clouds.hpp"

namespace talus::test {
namespace {

constexpr RandomStream draws{.seed = 51};

/// Particles stored cell by cell: own cells first, then the others as copies, each in an order of its own.
struct Stored {
    std::vector<std::array<double, 3>> position;
    std::vector<std::uint64_t> id;  ///< index in the cloud
    CellTable table;
};

enum class Storage { by_key, shuffled, every_third_cell_a_copy };

Stored store(const Cloud& cloud, Storage how) {
    const CellGrid grid(cloud.box, cloud.radius, cells_per_radius);
    std::vector<std::pair<CellKey, std::uint64_t>> sorted;
    for (std::size_t k = 0; k < cloud.points.size(); ++k) {
        Cell cell{};
        for (int axis = 0; axis < cloud.box.dimension; ++axis)
            cell[static_cast<std::size_t>(axis)] =
                grid.index_along(axis, cloud.points[k][static_cast<std::size_t>(axis)]);
        sorted.emplace_back(key_of(cell), k);
    }
    std::sort(sorted.begin(), sorted.end());
    struct Group {
        CellKey key;
        std::vector<std::uint64_t> ids;
        bool is_copy;
        double place;
    };
    std::vector<Group> groups;
    for (const auto& [key, id] : sorted) {
        if (groups.empty() || groups.back().key != key) {
            const bool is_copy = how == Storage::every_third_cell_a_copy && key % 3 == 0;
            groups.push_back({key, {}, is_copy, how == Storage::by_key ? 0 : draws.uniform(key, 0)});
        }
        groups.back().ids.push_back(id);
    }
    std::stable_sort(groups.begin(), groups.end(), [](const Group& a, const Group& b) {
        return a.is_copy != b.is_copy ? b.is_copy : a.place < b.place;
    });
    Stored stored;
    std::vector<CellEntry> entries;
    for (const Group& group : groups) {
        const auto begin = static_cast<std::uint32_t>(stored.id.size());
        for (const std::uint64_t id : group.ids) {
            stored.id.push_back(id);
            stored.position.push_back(cloud.points[id]);
        }
        entries.push_back(
            {group.key, begin, static_cast<std::uint32_t>(stored.id.size()), group.is_copy, false});
    }
    std::reverse(entries.begin(), entries.end());  // in any order
    stored.table.build(std::move(entries), cloud.box.dimension, cells_per_radius);
    return stored;
}

using Lists = std::vector<std::vector<std::uint64_t>>;  // partners of each particle, in order

template <int D>
Lists partner_lists(const Cloud& cloud, const Stored& stored, Cells which) {
    std::array<std::vector<double>, D> x;
    std::array<const double*, D> position;
    for (std::size_t d = 0; d < D; ++d) {
        for (const auto& point : stored.position) x[d].push_back(point[d]);
        position[d] = x[d].data();
    }
    Lists lists(stored.id.size());
    const std::vector<double> radius(stored.id.size(), cloud.radius);
    Partners<D> partners(position, radius.data(), 1);
    std::size_t before = 0, visits = 0;
    stored.table.for_each_own(which, [&](const CellEntry& cell, std::span<const Run> runs, std::size_t k) {
        EXPECT_TRUE(visits++ == 0 || k > before);
        before = k;
        partners.enter(cell, runs);
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            partners.find(i, 1);
            EXPECT_EQ(partners.index().size(), partners.count());
            for (const std::uint32_t j : partners.index()) lists[stored.id[i]].push_back(stored.id[j]);
        }
    });
    return lists;
}
Lists partner_lists(const Cloud& cloud, const Stored& stored, Cells which) {
    if (cloud.box.dimension == 1) return partner_lists<1>(cloud, stored, which);
    if (cloud.box.dimension == 2) return partner_lists<2>(cloud, stored, which);
    return partner_lists<3>(cloud, stored, which);
}

/// Clouds in boxes without images.
std::vector<Cloud> open_clouds() {
    std::vector<Cloud> clouds = all_clouds();
    for (Cloud& cloud : clouds) cloud.box.boundary = {};
    return clouds;
}

TEST(Partners, AreThoseOfBruteForceInOrderOfCellThenId) {
    for (const Cloud& cloud : open_clouds()) {
        SCOPED_TRACE(cloud.name);
        const CellGrid grid(cloud.box, cloud.radius, cells_per_radius);
        const Lists lists = partner_lists(cloud, store(cloud, Storage::by_key), Cells::all);
        std::vector<CellKey> key(cloud.points.size());
        std::vector<Point> points;
        for (std::size_t k = 0; k < key.size(); ++k) {
            Cell cell{};
            for (int axis = 0; axis < cloud.box.dimension; ++axis)
                cell[static_cast<std::size_t>(axis)] =
                    grid.index_along(axis, cloud.points[k][static_cast<std::size_t>(axis)]);
            key[k] = key_of(cell);
            points.push_back({k, cloud.points[k]});
        }
        for (std::size_t k = 0; k < lists.size(); ++k) {
            std::vector<std::uint64_t> expected;
            for (const Sighting& sighting : brute_force(cloud, points, points[k]))
                expected.push_back(sighting.id);
            std::sort(expected.begin(), expected.end(), [&](std::uint64_t a, std::uint64_t b) {
                return key[a] != key[b] ? key[a] < key[b] : a < b;
            });
            ASSERT_EQ(lists[k], expected) << "particle " << k;
        }
    }
}

TEST(Partners, OrderDoesNotDependOnWhereParticlesAreStored) {
    for (const Cloud& cloud : open_clouds()) {
        SCOPED_TRACE(cloud.name);
        const Lists expected = partner_lists(cloud, store(cloud, Storage::by_key), Cells::all);
        EXPECT_EQ(partner_lists(cloud, store(cloud, Storage::shuffled), Cells::all), expected);
        const Stored with_copies = store(cloud, Storage::every_third_cell_a_copy);
        const Lists some = partner_lists(cloud, with_copies, Cells::all);
        for (const CellEntry& cell : with_copies.table.cells())
            for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
                const std::uint64_t id = with_copies.id[i];
                ASSERT_EQ(some[id], cell.is_copy ? std::vector<std::uint64_t>{} : expected[id]);
            }
    }
}

TEST(Partners, InteriorCellsSeeNoCopiesAndWithBoundaryCellsAreAll) {
    for (const Cloud& cloud : open_clouds()) {
        SCOPED_TRACE(cloud.name);
        const Stored stored = store(cloud, Storage::every_third_cell_a_copy);
        std::vector<bool> is_copy(stored.id.size());
        for (const CellEntry& cell : stored.table.cells())
            for (std::uint32_t i = cell.begin; i < cell.end; ++i) is_copy[stored.id[i]] = cell.is_copy;
        const Lists all = partner_lists(cloud, stored, Cells::all),
                    interior = partner_lists(cloud, stored, Cells::interior),
                    boundary = partner_lists(cloud, stored, Cells::boundary);
        for (std::size_t k = 0; k < all.size(); ++k) {
            ASSERT_TRUE(interior[k].empty() || boundary[k].empty());
            ASSERT_EQ(interior[k].empty() ? boundary[k] : interior[k], all[k]);
            for (const std::uint64_t partner : interior[k]) ASSERT_FALSE(is_copy[partner]);
        }
    }
}

TEST(Partners, OneRadiusForEachParticle) {
    // 0 - 1 - 2 in a line, 1 apart; radii 0.5, 1.5, 2.5.
    const std::vector<double> x{0, 1, 2}, radius{0.5, 1.5, 2.5};
    const std::vector<talus::Run> runs{{0, 1}, {1, 3}};
    const auto in_own_cell = [](std::uint32_t i) { return CellEntry{i, i, i + 1, false, false}; };
    Partners<1> partners({x.data()}, radius.data(), 1);
    const auto mutual = [&](std::uint32_t i) {
        partners.enter(in_own_cell(i), runs);
        partners.find_mutual(i, 1);
        return std::vector<std::uint32_t>(partners.index().begin(), partners.index().end());
    };
    EXPECT_EQ(mutual(0), (std::vector<std::uint32_t>{1, 2}));
    EXPECT_EQ(mutual(1), (std::vector<std::uint32_t>{0, 2}));
    EXPECT_EQ(mutual(2), (std::vector<std::uint32_t>{0, 1}));
    const std::vector<double> one{1, 1, 1};
    Partners<1> exact({x.data()}, one.data(), 1);
    exact.enter(in_own_cell(1), runs);
    exact.find(1, 1);
    EXPECT_EQ(exact.count(), 0u) << "a distance equal to the radius is outside";
}

/// Compares with brute force the partners of 200 particles in two runs, cells of 1 to 7 particles, with
/// blocks and without; particles of radius 0 are not asked for theirs. Returns the pairs found.
std::size_t compare_with_brute_force(const std::array<std::vector<double>, 2>& x,
                                     const std::vector<double>& radius) {
    constexpr std::uint32_t known = 200;
    const std::vector<talus::Run> runs{{0, 61}, {75, known}};
    const auto is_in_a_run = [](std::uint32_t j) { return j < 61 || (75 <= j && j < known); };
    Partners<2> plain({x[0].data(), x[1].data()}, radius.data(), 1),
        blocks({x[0].data(), x[1].data()}, radius.data(), 1);
    blocks.search_by_blocks(known);
    std::size_t pairs = 0;
    for (std::uint32_t begin = 75, size = 1; begin + size <= known; begin += size, size = size % 7 + 1) {
        for (Partners<2>* partners : {&plain, &blocks}) {
            partners->enter({begin, begin, begin + size, false, false}, runs);
            for (std::uint32_t i = begin; i < begin + size; ++i) {
                if (radius[i] == 0) continue;
                std::vector<std::uint32_t> within, mutual;
                for (std::uint32_t j = 0; j < known; ++j) {
                    const double r = std::hypot(x[0][i] - x[0][j], x[1][i] - x[1][j]);
                    if (j == i || !is_in_a_run(j)) continue;
                    if (r < radius[i]) within.push_back(j);
                    if (r < std::max(radius[i], radius[j])) mutual.push_back(j);
                }
                partners->find(i, 1);
                EXPECT_EQ(std::vector(partners->index().begin(), partners->index().end()), within);
                partners->find_mutual(i, 1);
                EXPECT_EQ(std::vector(partners->index().begin(), partners->index().end()), mutual);
                pairs += mutual.size();
            }
        }
    }
    return pairs;
}

TEST(Partners, OfUnlikeRadiiAreThoseOfBruteForceWithBlocksAndWithout) {
    std::array<std::vector<double>, 2> x;
    std::vector<double> radius;  // over two decades
    for (std::uint64_t k = 0; k < 203; ++k) {
        for (std::uint32_t d = 0; d < 2; ++d) x[d].push_back(draws.uniform(k, 10 + d));
        radius.push_back(0.01 * std::pow(100, draws.uniform(k, 12)));
    }
    EXPECT_GT(compare_with_brute_force(x, radius), 1000u);
    for (std::size_t k = 0; k < radius.size(); ++k)  // whole cells of none, and cells of some
        if (k % 32 < 20 || k % 3 == 0) radius[k] = 0;
    EXPECT_GT(compare_with_brute_force(x, radius), 100u);
}

TEST(Partners, NoneInAnEmptyTable) {
    CellTable table;
    table.build({}, 3, 2);
    table.for_each_own(Cells::all,
                       [](const CellEntry&, std::span<const talus::Run>, std::size_t) { FAIL(); });
}

}  // namespace
}  // namespace talus::test
