#include <gtest/gtest.h>

#include "domain/polygon.hpp"

namespace talus {
namespace {

/// A square of 10 m far from the origin with a hole of 2 m, and an island of 1 m in it.
Polygon island() {
    const auto square = [](double half) {
        return Polygon::Ring{{1e5 - half, 2e5 - half},
                             {1e5 + half, 2e5 - half},
                             {1e5 + half, 2e5 + half},
                             {1e5 - half, 2e5 + half}};
    };
    Polygon polygon;
    polygon.rings = {square(5), square(1), square(0.5)};
    return polygon;
}

TEST(Polygon, HolesAreOutside) {
    const Polygon polygon = island();
    EXPECT_TRUE(polygon.contains(1e5 - 4.9, 2e5 + 4.9));
    EXPECT_FALSE(polygon.contains(1e5 + 0.8, 2e5));
    EXPECT_TRUE(polygon.contains(1e5 + 0.3, 2e5 - 0.3));
    EXPECT_FALSE(polygon.contains(1e5 + 5.1, 2e5));
    EXPECT_FALSE(polygon.contains(1e5, 2e5 + 5.1));
}

TEST(Polygon, AreaLeavesHolesOut) { EXPECT_NEAR(island().area(), 100 - 4 + 1, 1e-9); }

TEST(Polygon, EveryPlaceIsInOneOfTwoNeighbours) {
    Polygon left, right;
    left.rings = {{{0, 0}, {3, 1}, {2, 5}, {0, 4}}};
    right.rings = {{{3, 1}, {7, 0}, {6, 6}, {2, 5}}};
    for (double x = 0.6; x < 6; x += 0.25)
        for (double y = 1.1; y < 3.9; y += 0.25)
            EXPECT_NE(left.contains(x, y), right.contains(x, y)) << x << ' ' << y;
}

TEST(Polygon, BoundsHoldAllCorners) {
    EXPECT_EQ(island().lower(), (std::array<double, 2>{1e5 - 5, 2e5 - 5}));
    EXPECT_EQ(island().upper(), (std::array<double, 2>{1e5 + 5, 2e5 + 5}));
}

}  // namespace
}  // namespace talus
