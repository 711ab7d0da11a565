#include <gtest/gtest.h>

#include "domain/random.hpp"
#include "physics/sph/kernels.hpp"
#include "src/setup/glass.hpp"

namespace talus::test {
namespace {

/// Sums over a periodic packing of unit spacing.
struct Evenness {
    double mean_density = 0;  ///< points per unit volume
    double deviation = 0;     ///< of the density, root of the mean square, relative
    double nearest = 1e30;    ///< least distance of two points
};
template <int D>
Evenness evenness(const UnitCell& cell, double h) {
    const sph::CubicSpline<D> kernel;
    Evenness result;
    std::vector<double> densities;
    for (const Point& a : cell.points) {
        double density = 0;
        for (const Point& b : cell.points) {
            double r2 = 0;
            for (std::size_t axis = 0; axis < D; ++axis) {
                const double d = a[axis] - b[axis], apart = cell.edges[axis] * (d - std::rint(d));
                r2 += apart * apart;
            }
            if (&a != &b) result.nearest = std::min(result.nearest, std::sqrt(r2));
            density += kernel.value(r2, 1 / h);
        }
        densities.push_back(density);
        result.mean_density += density / static_cast<double>(cell.points.size());
    }
    for (const double density : densities)
        result.deviation +=
            std::pow(density / result.mean_density - 1, 2) / static_cast<double>(densities.size());
    result.deviation = std::sqrt(result.deviation);
    return result;
}

/// Points strewn at random, not relaxed, with the same number and cell.
template <int D>
UnitCell gas_like(const UnitCell& glass) {
    UnitCell cell = glass;
    const RandomStream random{.seed = 5};
    for (std::size_t i = 0; i < cell.points.size(); ++i)
        for (std::size_t a = 0; a < D; ++a)
            cell.points[i][a] = random.uniform(i, static_cast<std::uint32_t>(a));
    return cell;
}

// The density that another kernel than that of the relaxation gives, the cubic spline with h = 1.3 spacings
// (74 neighbours in 3D): its mean is 1 by normalisation, and lattices of a perfect crystal give no scatter.
// Points at random scatter by a sixth or more. No lattice: neighbours' sums differ from point to point.
template <int D>
void expect_quiet(double most) {
    const UnitCell glass = glass_cell(D, 1);
    EXPECT_EQ(static_cast<double>(glass.points.size()), std::round(std::pow(glass.edges[0], D)));
    const Evenness found = evenness<D>(glass, 1.3);
    EXPECT_NEAR(found.mean_density, 1, 0.005);
    EXPECT_LT(found.deviation, most);
    EXPECT_GT(found.deviation, 1e-5);
    EXPECT_GT(found.nearest, 0.8);
    EXPECT_GT(evenness<D>(gas_like<D>(glass), 1.3).deviation, 0.15);
    testing::Test::RecordProperty("density_deviation", std::to_string(found.deviation));
    for (const Point& point : glass.points)
        for (std::size_t a = 0; a < D; ++a) EXPECT_TRUE(0 <= point[a] && point[a] <= 1);
}

TEST(Glass, IsQuietIn3D) { expect_quiet<3>(0.005); }
TEST(Glass, IsQuietIn2D) { expect_quiet<2>(0.01); }

TEST(Glass, DependsOnTheSeedAlone) {
    const UnitCell first = glass_cell(2, 1), again = glass_cell(2, 1), other = glass_cell(2, 2);
    EXPECT_EQ(first.points, again.points);
    EXPECT_NE(first.points, other.points);
}

// A glass of many cells fills a sphere with as many points as its volume holds, to the scatter at its
// surface.
TEST(Glass, FillsAShape) {
    const UnitCell glass = glass_cell(3, 1);
    double count = 0;
    const SphereShape ball{{1, 2, 3}, 15};
    for_each_point(ball, glass, 1, 3, [&](const Point& point) {
        ++count;
        EXPECT_TRUE(contains(ball, point, 3));
    });
    EXPECT_NEAR(count / volume(ball, 3), 1, 0.005);
}

}  // namespace
}  // namespace talus::test
