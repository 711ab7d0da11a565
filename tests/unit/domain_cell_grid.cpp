#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "domain/cell_grid.hpp"
#include "domain/random.hpp"

namespace talus {
namespace {

Box box_of(int dimension, Boundary x, Boundary y = Boundary::open, Boundary z = Boundary::open) {
    Box box;
    box.dimension = dimension;
    box.lower = {-1, 2, 0};
    box.upper = {1, 3, 0.5};
    box.boundary = {x, y, z};
    return box;
}

TEST(CellKey, RoundTrip) {
    for (const int x : {-cell_limit - 8, -1000, -1, 0, 1, 77, cell_limit + 8})
        for (const int y : {-cell_limit - 8, -3, 0, 5, cell_limit + 8})
            for (const int z : {-cell_limit - 8, -1, 0, 1, cell_limit + 8}) {
                const Cell cell{x, y, z};
                EXPECT_EQ(cell_of(key_of(cell)), cell);
            }
}

TEST(CellKey, OrderIsByZThenYThenX) {
    constexpr RandomStream draws{.seed = 1};
    const auto cell_at = [&](std::uint64_t k) {
        Cell cell;
        for (std::uint32_t a = 0; a < 3; ++a) cell[a] = static_cast<int>(7 * draws.uniform(k, a)) - 3;
        return cell;
    };
    for (std::uint64_t k = 0; k < 2000; ++k) {
        const Cell p = cell_at(2 * k), q = cell_at(2 * k + 1);
        const Cell p_zyx{p[2], p[1], p[0]}, q_zyx{q[2], q[1], q[0]};
        EXPECT_EQ(key_of(p) < key_of(q), p_zyx < q_zyx);
        EXPECT_EQ(key_of(p) == key_of(q), p == q);
    }
    EXPECT_EQ(key_of({5, 2, 1}) + 1, key_of({6, 2, 1}));
    EXPECT_EQ(key_of({-1, 2, 1}) + 1, key_of({0, 2, 1}));
}

TEST(CellGrid, OpenAxesHaveCellsOfRadiusOverReach) {
    const CellGrid grid(box_of(2, Boundary::open), 0.3, 2);
    EXPECT_EQ(grid.cell_size(0), 0.15);
    EXPECT_EQ(grid.cell_count(0), 0);
    EXPECT_EQ(grid.covered_radius(), 0.3);
    EXPECT_EQ(grid.index_along(0, 0.0), 0);
    EXPECT_EQ(grid.index_along(0, 0.16), 1);
    EXPECT_EQ(grid.index_along(0, -1e-9), -1);
    EXPECT_EQ(grid.index_along(0, -0.16), -2);
}

TEST(CellGrid, ClosedAxesHoldAWholeNumberOfCells) {
    for (const Boundary kind : {Boundary::periodic, Boundary::reflecting})
        for (const int reach : {1, 2, 3})
            for (const double radius : {0.5, 0.3, 0.07, 0.011}) {
                const CellGrid grid(box_of(3, kind, kind, kind), radius, reach);
                for (int axis = 0; axis < 3; ++axis) {
                    const double length = grid.box().length(axis);
                    EXPECT_NEAR(grid.cell_count(axis) * grid.cell_size(axis), length, 1e-14);
                    EXPECT_GE(grid.cell_size(axis) * reach, radius * (1 - 1e-15));
                    EXPECT_LT(grid.cell_size(axis) * reach, 2 * radius);
                    EXPECT_GE(grid.cell_size(axis) * reach, grid.covered_radius());
                }
                EXPECT_GE(grid.covered_radius(), radius * (1 - 1e-15));
            }
}

TEST(CellGrid, RefusesWhatCannotBe) {
    EXPECT_THROW(CellGrid(box_of(1, Boundary::open), 0, 2), std::invalid_argument);
    EXPECT_THROW(CellGrid(box_of(1, Boundary::open), -1, 2), std::invalid_argument);
    EXPECT_THROW(CellGrid(box_of(1, Boundary::open), std::nan(""), 2), std::invalid_argument);
    EXPECT_THROW(CellGrid(box_of(1, Boundary::open), std::numeric_limits<double>::infinity(), 2),
                 std::invalid_argument);
    EXPECT_THROW(CellGrid(box_of(2, Boundary::open, Boundary::periodic), 1.01, 2), std::invalid_argument);
    EXPECT_THROW(CellGrid(box_of(2, Boundary::open, Boundary::reflecting), 1.01, 2), std::invalid_argument);
    EXPECT_NO_THROW(CellGrid(box_of(2, Boundary::open, Boundary::periodic), 1.0, 2));
    EXPECT_NO_THROW(CellGrid(box_of(2, Boundary::open, Boundary::open), 1.01, 2));
}

TEST(CellGrid, PositionsOnAndBeyondTheEndsOfClosedAxesAreInside) {
    for (const double radius : {1.0, 0.3, 0.1, 0.03}) {
        const CellGrid grid(box_of(1, Boundary::reflecting), radius, 2);
        const int last = grid.cell_count(0) - 1;
        EXPECT_EQ(grid.index_along(0, -1.0), 0);
        EXPECT_EQ(grid.index_along(0, 1.0), last);
        EXPECT_EQ(grid.index_along(0, std::nextafter(1.0, 0.0)), last);
        EXPECT_EQ(grid.index_along(0, -7.0), 0);
        EXPECT_EQ(grid.index_along(0, 7.0), last);
    }
}

TEST(CellGrid, IndexGrowsWithTheCoordinateAndHasALimit) {
    const CellGrid grid(box_of(1, Boundary::open), 0.2, 2);
    int before = -cell_limit;
    for (double x = -30; x < 30; x += 0.0137) {
        const int index = grid.index_along(0, x);
        EXPECT_GE(index, before);
        EXPECT_NEAR(index + 0.5, x / 0.1, 0.5 + 1e-9);
        before = index;
    }
    EXPECT_EQ(grid.index_along(0, 1e300), cell_limit);
    EXPECT_EQ(grid.index_along(0, -1e300), -cell_limit);
    EXPECT_EQ(grid.index_along(0, std::numeric_limits<double>::infinity()), cell_limit);
}

TEST(CellGrid, LadderRadiusIsTheNextRung) {
    constexpr RandomStream draws{.seed = 2};
    for (std::uint64_t k = 0; k < 5000; ++k) {
        const double radius = std::exp2(200 * (draws.uniform(k, 0) - 0.5));
        const double rung = CellGrid::ladder_radius(radius);
        EXPECT_GE(rung, radius);
        EXPECT_LT(rung, radius * 1.0906);
        EXPECT_EQ(CellGrid::ladder_radius(rung), rung);
    }
    for (const double rung : {0.25, 1.0, 4.0, 0x1p300}) {
        EXPECT_EQ(CellGrid::ladder_radius(rung), rung);
        EXPECT_NEAR(CellGrid::ladder_radius(std::nextafter(rung, 1e300)) / rung, std::exp2(0.125), 1e-15);
    }
}

TEST(Images, OpenAxesHaveNone) {
    const CellGrid grid(box_of(3, Boundary::open), 0.3, 2);
    EXPECT_FALSE(grid.has_copies({0, 0, 0}));
    const auto images = grid.images({3, -4, 5});
    ASSERT_EQ(images.size(), 1u);
    EXPECT_TRUE(images[0].is_original());
    EXPECT_EQ(images[0].cell, (Cell{3, -4, 5}));
}

TEST(Images, PeriodicAxis) {
    const CellGrid grid(box_of(1, Boundary::periodic), 0.5, 2);  // 8 cells of 0.25
    ASSERT_EQ(grid.cell_count(0), 8);
    for (int index = 0; index < 8; ++index) {
        const auto images = grid.images({index, 0, 0});
        const bool at_edge = index < 2 || index > 5;
        EXPECT_EQ(grid.has_copies({index, 0, 0}), at_edge);
        ASSERT_EQ(images.size(), at_edge ? 2u : 1u);
        if (!at_edge) continue;
        EXPECT_EQ(images[1].cell[0], index < 2 ? index + 8 : index - 8);
        EXPECT_EQ(images[1].shift[0], index < 2 ? 2.0 : -2.0);
        EXPECT_FALSE(images[1].flip[0]);
    }
}

TEST(Images, ReflectingAxis) {
    const CellGrid grid(box_of(1, Boundary::reflecting), 0.5, 2);
    const auto low = grid.images({1, 0, 0}), high = grid.images({7, 0, 0});
    ASSERT_EQ(low.size(), 2u);
    EXPECT_EQ(low[1].cell[0], -2);
    EXPECT_EQ(low[1].shift[0], -2.0);  // x -> -2 - x
    EXPECT_TRUE(low[1].flip[0]);
    ASSERT_EQ(high.size(), 2u);
    EXPECT_EQ(high[1].cell[0], 8);
    EXPECT_EQ(high[1].shift[0], 2.0);
    EXPECT_TRUE(high[1].flip[0]);
}

TEST(Images, CornersCombineTheAxes) {
    const CellGrid grid(box_of(3, Boundary::periodic, Boundary::reflecting, Boundary::periodic), 0.25, 2);
    const auto images = grid.images({0, 0, 0});
    ASSERT_EQ(images.size(), 8u);
    std::set<Cell> cells;
    for (const Image& image : images) {
        cells.insert(image.cell);
        EXPECT_EQ(image.shift[0] != 0, image.cell[0] != 0);
        EXPECT_EQ(image.flip[1], image.cell[1] != 0);
        EXPECT_EQ(image.shift[2] != 0, image.cell[2] != 0);
        EXPECT_FALSE(image.flip[0] || image.flip[2]);
    }
    EXPECT_EQ(cells.size(), 8u) << "two images in one cell";
}

TEST(Images, BoxAsNarrowAsTheRadius) {
    const CellGrid one_cell(box_of(1, Boundary::periodic), 2.0, 1);
    ASSERT_EQ(one_cell.cell_count(0), 1);
    const auto images = one_cell.images({0, 0, 0});
    ASSERT_EQ(images.size(), 3u);
    EXPECT_EQ(images[1].cell[0], -1);
    EXPECT_EQ(images[1].shift[0], -2.0);
    EXPECT_EQ(images[2].cell[0], 1);
    EXPECT_EQ(images[2].shift[0], 2.0);

    const CellGrid two_cells(box_of(1, Boundary::periodic), 2.0, 2);
    ASSERT_EQ(two_cells.cell_count(0), 2);
    EXPECT_EQ(two_cells.images({0, 0, 0}).size(), 3u);

    const CellGrid walls(box_of(1, Boundary::reflecting), 2.0, 1);
    const auto mirrored = walls.images({0, 0, 0});
    ASSERT_EQ(mirrored.size(), 3u);
    EXPECT_EQ(mirrored[1].cell[0], -1);
    EXPECT_EQ(mirrored[2].cell[0], 1);
}

/// Every cell of the box is imaged exactly once into each cell within reach of the box.
TEST(Images, FillTheSurroundingsOfTheBoxOnce) {
    for (const Boundary kind : {Boundary::periodic, Boundary::reflecting})
        for (const int reach : {1, 2})
            for (const double radius : {0.5, 0.3, 0.16}) {
                const CellGrid grid(box_of(3, kind, kind, kind), radius, reach);
                std::set<Cell> filled;
                std::size_t images = 0;
                for (int z = 0; z < grid.cell_count(2); ++z)
                    for (int y = 0; y < grid.cell_count(1); ++y)
                        for (int x = 0; x < grid.cell_count(0); ++x)
                            for (const Image& image : grid.images({x, y, z})) {
                                filled.insert(image.cell);
                                ++images;
                            }
                std::size_t expected = 1;
                for (int axis = 0; axis < 3; ++axis)
                    expected *= static_cast<std::size_t>(grid.cell_count(axis) + 2 * reach);
                EXPECT_EQ(images, expected);
                EXPECT_EQ(filled.size(), expected);
            }
}

/// Images of a sheared box: whatever two points are within the radius of each other, the displaced copy of
/// the one stands in a cell within reach of the other's.
TEST(CellGrid, ShearedImagesStandWithinReach) {
    Box box{3, {-1, 2, 0}, {1, 3, 0.9}, {Boundary::periodic, Boundary::periodic, Boundary::periodic}, 1};
    const double radius = 0.22;
    CellGrid grid(box, radius, 1);
    EXPECT_GE(grid.cell_size(0), 2 * radius);
    EXPECT_GE(grid.covered_radius(), radius);
    const auto cell_of_point = [&](const std::array<double, 3>& x) {
        return Cell{grid.index_along(0, x[0]), grid.index_along(1, x[1]), grid.index_along(2, x[2])};
    };
    constexpr RandomStream draws{.seed = 3};
    int across = 0;
    for (std::uint64_t k = 0; k < 4000; ++k) {
        const double offset = 2 * draws.uniform(k, 6);
        grid.displace_images(offset);
        std::array<double, 3> a{}, b{};  // near each other, across boundaries or not
        for (std::uint32_t c = 0; c < 3; ++c) {
            a[c] = box.lower[c] + box.length(static_cast<int>(c)) * draws.uniform(k, c);
            b[c] = a[c] + radius * (2 * draws.uniform(k, 3 + c) - 1);
        }
        const double turns = std::floor((b[1] - box.lower[1]) / box.length(1));
        b[0] -= turns * offset;
        for (std::size_t c = 0; c < 3; ++c) {
            const double length = box.length(static_cast<int>(c));
            b[c] -= length * std::floor((b[c] - box.lower[c]) / length);
        }
        const Cell own = cell_of_point(a);
        std::set<std::array<int, 3>> seen;
        for (const Image& image : grid.images(cell_of_point(b))) EXPECT_TRUE(seen.insert(image.cell).second);
        for (int x = -3; x <= 3; ++x)
            for (int y = -1; y <= 1; ++y)
                for (int z = -1; z <= 1; ++z) {
                    const std::array<double, 3> shift{y * offset + x * 2.0, y * 1.0, z * 0.9};
                    double distance2 = 0;
                    for (std::size_t c = 0; c < 3; ++c)
                        distance2 += (b[c] + shift[c] - a[c]) * (b[c] + shift[c] - a[c]);
                    if (distance2 > radius * radius) continue;
                    int found = 0;
                    for (const Image& image : grid.images(cell_of_point(b))) {
                        bool same = true, near = true;
                        for (std::size_t c = 0; c < 3; ++c) {
                            same &= std::abs(image.shift[c] - shift[c]) < 1e-12;
                            near &= std::abs(image.cell[c] - own[c]) <= 1;
                        }
                        found += same && near ? 1 : 0;
                    }
                    EXPECT_EQ(found, 1) << "pair " << k << " at image " << x << " " << y << " " << z;
                    across += y != 0 ? 1 : 0;
                }
    }
    EXPECT_GT(across, 100);
}

}  // namespace
}  // namespace talus
