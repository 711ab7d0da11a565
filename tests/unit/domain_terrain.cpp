#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "domain/terrain.hpp"
#include "domain/terrain_smoothing.hpp"

namespace talus {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

template <class Surface>
TerrainGrid grid_of(Surface&& surface, std::size_t columns = 9, std::size_t rows = 7) {
    TerrainGrid grid{
        .origin = {100, -40}, .spacing = {5, 4}, .columns = columns, .rows = rows, .elevations = {}};
    for (std::size_t row = 0; row < rows; ++row)
        for (std::size_t column = 0; column < columns; ++column)
            grid.elevations.push_back(
                surface(100 + 5.0 * static_cast<double>(column), -40 + 4.0 * static_cast<double>(row)));
    return grid;
}

double slant(double x, double y) { return 700 - 0.6 * x + 0.25 * y; }
double bowl(double x, double y) { return 3 + 0.02 * x * x - 0.03 * x * y + 0.05 * y * y - x + 2 * y; }
double rough(double x, double y) { return 20 * std::sin(0.9 * x) * std::cos(1.3 * y) + 0.1 * x; }

/// Tolerance: rounding of numbers of about 1000 divided by the square of the spacing.
constexpr double rounding = 1e-10;

void expect_slant(const Terrain& terrain, double x, double y) {
    const TerrainPoint point = terrain.at(x, y);
    EXPECT_NEAR(point.elevation, slant(x, y), rounding) << x << ' ' << y;
    EXPECT_NEAR(point.slope[0], -0.6, rounding);
    EXPECT_NEAR(point.slope[1], 0.25, rounding);
    for (const double curvature : point.curvature) EXPECT_NEAR(curvature, 0, rounding);
}

TEST(Terrain, APlaneHasNoBounds) {
    const Terrain plane(700, {-0.6, 0.25});
    EXPECT_TRUE(plane.is_plane());
    EXPECT_TRUE(plane.contains(-1e9, 1e9));
    expect_slant(plane, 123.4, -56.7);
}

TEST(Terrain, LinearSurfacesAreExactUpToTheRim) {
    const Terrain terrain(grid_of(slant));
    for (double x = 100; x <= 140; x += 1.25)
        for (double y = -40; y <= -16; y += 0.75) expect_slant(terrain, x, y);
}

TEST(Terrain, QuadraticSurfacesAreExactOneCellInside) {
    const Terrain terrain(grid_of(bowl));
    for (double x = 105; x <= 135; x += 0.7)
        for (double y = -36; y <= -20; y += 0.45) {
            const TerrainPoint point = terrain.at(x, y);
            EXPECT_NEAR(point.elevation, bowl(x, y), rounding);
            EXPECT_NEAR(point.slope[0], 0.04 * x - 0.03 * y - 1, rounding);
            EXPECT_NEAR(point.slope[1], -0.03 * x + 0.1 * y + 2, rounding);
            EXPECT_NEAR(point.curvature[0], 0.04, rounding);
            EXPECT_NEAR(point.curvature[1], 0.1, rounding);
            EXPECT_NEAR(point.curvature[2], -0.03, rounding);
        }
}

/// Across the lines through the points, next to a hole and at the rim too; the second derivative must jump
/// there on a rough surface, or the test would not see a kink.
TEST(Terrain, SlopeIsContinuousAndTheDerivativeOfTheElevation) {
    TerrainGrid grid = grid_of(rough);
    grid.elevations[3 * 9 + 4] = unknown;
    const Terrain terrain(grid);
    constexpr double step = 1e-7;
    double jump_of_slope = 0, jump_of_curvature = 0, wrong_slope = 0;
    int places = 0;
    const auto compare = [&](double x, double y, double dx, double dy) {
        if (!terrain.contains(x - dx, y - dy) || !terrain.contains(x + dx, y + dy)) return;
        const TerrainPoint before = terrain.at(x - dx, y - dy), after = terrain.at(x + dx, y + dy);
        for (std::size_t axis = 0; axis < 2; ++axis) {
            jump_of_slope = std::max(jump_of_slope, std::abs(after.slope[axis] - before.slope[axis]));
            jump_of_curvature =
                std::max(jump_of_curvature, std::abs(after.curvature[axis] - before.curvature[axis]));
        }
        const double along = dx > 0 ? after.slope[0] : after.slope[1];
        wrong_slope =
            std::max(wrong_slope, std::abs((after.elevation - before.elevation) / (2 * step) - along));
        ++places;
    };
    for (double t = 0.3; t < 24; t += 0.7) {
        for (double x = 105; x < 140; x += 5) compare(x, -40 + t, step, 0);
        for (double y = -36; y < -16; y += 4) compare(100 + t * 40 / 24, y, 0, step);
    }
    EXPECT_GT(places, 300);
    EXPECT_GT(jump_of_curvature, 0.1);
    // Curvature (about 5 per metre at most) times 2 steps; the quotient loses 20 * 2^-52 / step.
    EXPECT_LT(jump_of_slope, 5 * 2 * step);
    EXPECT_LT(wrong_slope, 5 * 2 * step + 1e-6);
}

TEST(Terrain, PassesThroughItsPoints) {
    const TerrainGrid grid = grid_of(rough);
    const Terrain terrain(grid);
    for (std::size_t row = 0; row < grid.rows; ++row)
        for (std::size_t column = 0; column < grid.columns; ++column)
            EXPECT_DOUBLE_EQ(terrain.elevation(100 + 5.0 * static_cast<double>(column),
                                               -40 + 4.0 * static_cast<double>(row)),
                             grid.at(column, row));
}

TEST(Terrain, HolesAndTheOutsideAreTold) {
    TerrainGrid grid = grid_of(slant);
    grid.elevations[3 * 9 + 4] = unknown;  // (120, -28)
    const Terrain terrain(grid);
    EXPECT_EQ(terrain.place(118, -27), Terrain::Place::hole);
    EXPECT_EQ(terrain.place(123, -31), Terrain::Place::hole);
    EXPECT_EQ(terrain.place(114.9, -27), Terrain::Place::known);
    EXPECT_EQ(terrain.place(99.9, -27), Terrain::Place::outside);
    EXPECT_EQ(terrain.place(110, -15.9), Terrain::Place::outside);
    EXPECT_EQ(terrain.place(unknown, -27), Terrain::Place::outside);
    EXPECT_TRUE(terrain.contains(140, -16));
    EXPECT_TRUE(std::isnan(terrain.elevation(118, -27)));
    EXPECT_TRUE(std::isnan(terrain.elevation(99, -27)));
    EXPECT_EQ(terrain.cell_name(120.1, -28.2), "column 5, row 4");
    EXPECT_EQ(terrain.cell_name(100, -16), "column 1, row 1");
    EXPECT_EQ(terrain.cell_name(99, -27), "");
    expect_slant(terrain, 114, -27);
    expect_slant(terrain, 126, -33);
}

TEST(Terrain, RefusesGridsThatAreNone) {
    TerrainGrid grid = grid_of(slant);
    grid.elevations.pop_back();
    EXPECT_THROW(Terrain{grid}, std::invalid_argument);
    EXPECT_THROW(Terrain{grid_of(slant, 1, 7)}, std::invalid_argument);
    grid = grid_of(slant);
    grid.spacing[1] = -4;
    EXPECT_THROW(Terrain{grid}, std::invalid_argument);
}

// Also next to what is not known and at the rim: points count in pairs.
TEST(TerrainSmoothing, KeepsPlanesAndWhatIsNotKnown) {
    TerrainGrid grid = grid_of(slant, 20, 15);
    grid.elevations[7 * 20 + 8] = unknown;
    const TerrainGrid found = smoothed(grid, 17);
    for (std::size_t k = 0; k < grid.elevations.size(); ++k) {
        if (std::isnan(grid.elevations[k]))
            EXPECT_TRUE(std::isnan(found.elevations[k]));
        else
            EXPECT_NEAR(found.elevations[k], grid.elevations[k], rounding);
    }
}

// Weights that fall linearly over n spacings leave (sin(n a/2)/(n sin(a/2)))^2 of a wave of phase a a
// spacing: the sum of Fejer's kernel.
TEST(TerrainSmoothing, TakesTheirShareOfWaves) {
    const double phase = 0.7;
    const TerrainGrid grid =
        grid_of([&](double x, double) { return std::cos(phase * (x - 200) / 5); }, 41, 5);
    const TerrainGrid found = smoothed(grid, 4 * 5.0);
    const double left = std::pow(std::sin(2 * phase) / (4 * std::sin(phase / 2)), 2);
    EXPECT_NEAR(found.at(20, 2), left, 1e-12);
    EXPECT_EQ(smoothed(grid, 4).elevations, grid.elevations);
    EXPECT_EQ(smoothed(grid, 0).elevations, grid.elevations);
}

}  // namespace
}  // namespace talus
