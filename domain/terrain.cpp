#include "domain/terrain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace talus {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Weights of four points in a row for the value and the derivatives at `t` in [0, 1] between the middle two.
struct CubicWeights {
    std::array<double, 4> value, first, second;
};

CubicWeights cubic_weights(double t) {
    const double t2 = t * t, t3 = t2 * t;
    return {{0.5 * (-t3 + 2 * t2 - t), 0.5 * (3 * t3 - 5 * t2) + 1, 0.5 * (-3 * t3 + 4 * t2 + t),
             0.5 * (t3 - t2)},
            {0.5 * (-3 * t2 + 4 * t - 1), 0.5 * (9 * t2 - 10 * t), 0.5 * (-9 * t2 + 8 * t + 1),
             0.5 * (3 * t2 - 2 * t)},
            {-3 * t + 2, 9 * t - 5, -9 * t + 4, 3 * t - 1}};
}

/// The cell between points that holds a coordinate, and where in it.
struct Within {
    std::size_t cell;
    double t;
};

Within within(double coordinate, double lower, double spacing, std::size_t points) {
    const double place = (coordinate - lower) / spacing;
    const std::size_t cell = std::min(static_cast<std::size_t>(place), points - 2);
    return {cell, place - static_cast<double>(cell)};
}

}  // namespace

Terrain::Terrain(double elevation, std::array<double, 2> slope)
    : elevation_(elevation), slope_(slope), lower_{-infinity, -infinity}, upper_{infinity, infinity} {}

Terrain::Terrain(TerrainGrid grid)
    : lower_(grid.origin), upper_(), spacing_(grid.spacing), columns_(grid.columns), rows_(grid.rows) {
    if (columns_ < 2 || rows_ < 2 || grid.elevations.size() != columns_ * rows_)
        throw std::invalid_argument(fmt::format("a terrain of {} x {} points with {} elevations", columns_,
                                                rows_, grid.elevations.size()));
    if (!(spacing_[0] > 0 && spacing_[1] > 0))
        throw std::invalid_argument("the spacing of a terrain's points is not positive");
    upper_ = {lower_[0] + spacing_[0] * static_cast<double>(columns_ - 1),
              lower_[1] + spacing_[1] * static_cast<double>(rows_ - 1)};

    is_known_.resize((columns_ - 1) * (rows_ - 1));
    for (std::size_t row = 0; row + 1 < rows_; ++row)
        for (std::size_t column = 0; column + 1 < columns_; ++column)
            is_known_[row * (columns_ - 1) + column] =
                !std::isnan(grid.at(column, row)) && !std::isnan(grid.at(column + 1, row)) &&
                !std::isnan(grid.at(column, row + 1)) && !std::isnan(grid.at(column + 1, row + 1));

    nodes_.assign((columns_ + 2) * (rows_ + 2), unknown);
    for (std::size_t row = 0; row < rows_; ++row)
        for (std::size_t column = 0; column < columns_; ++column)
            node(column + 1, row + 1) = grid.at(column, row);
    extrapolate();
}

/// Gives every point that is not known, but beside one that is, the mean of the linear extrapolations along
/// rows, columns and diagonals; a single value a point keeps the surface smooth across cells.
void Terrain::extrapolate() {
    const auto columns = static_cast<std::ptrdiff_t>(columns_ + 2);
    const auto rows = static_cast<std::ptrdiff_t>(rows_ + 2);
    const std::vector<double> known = nodes_;
    const auto value = [&](std::ptrdiff_t column, std::ptrdiff_t row) {
        const bool is_inside = 0 <= column && column < columns && 0 <= row && row < rows;
        return is_inside ? known[static_cast<std::size_t>(row * columns + column)] : unknown;
    };
    for (std::ptrdiff_t row = 0; row < rows; ++row)
        for (std::ptrdiff_t column = 0; column < columns; ++column) {
            if (!std::isnan(value(column, row))) continue;
            double sum = 0;
            int count = 0;
            for (std::ptrdiff_t down = -1; down <= 1; ++down)
                for (std::ptrdiff_t right = -1; right <= 1; ++right) {
                    const double line =
                        2 * value(column + right, row + down) - value(column + 2 * right, row + 2 * down);
                    if (std::isnan(line)) continue;
                    sum += line;
                    ++count;
                }
            if (count > 0) nodes_[static_cast<std::size_t>(row * columns + column)] = sum / count;
        }
}

Terrain::Place Terrain::place(double x, double y) const {
    if (is_plane()) return Place::known;
    // Negated, so that a coordinate that is not a number is outside.
    if (!(lower_[0] <= x && x <= upper_[0] && lower_[1] <= y && y <= upper_[1])) return Place::outside;
    const std::size_t column = within(x, lower_[0], spacing_[0], columns_).cell;
    const std::size_t row = within(y, lower_[1], spacing_[1], rows_).cell;
    return is_known_[row * (columns_ - 1) + column] ? Place::known : Place::hole;
}

TerrainPoint Terrain::at(double x, double y) const {
    if (is_plane()) return {elevation_ + slope_[0] * x + slope_[1] * y, slope_, {0, 0, 0}};
    if (!contains(x, y)) return {unknown, {unknown, unknown}, {unknown, unknown, unknown}};

    const Within column = within(x, lower_[0], spacing_[0], columns_);
    const Within row = within(y, lower_[1], spacing_[1], rows_);
    const CubicWeights along_x = cubic_weights(column.t), along_y = cubic_weights(row.t);
    TerrainPoint point{};
    for (std::size_t j = 0; j < 4; ++j) {
        const double* z = nodes_.data() + (row.cell + j) * (columns_ + 2) + column.cell;
        const auto sum = [&](const std::array<double, 4>& w) {
            return (w[0] * z[0] + w[1] * z[1]) + (w[2] * z[2] + w[3] * z[3]);
        };
        const double value = sum(along_x.value), first = sum(along_x.first);
        point.elevation += along_y.value[j] * value;
        point.slope[0] += along_y.value[j] * first;
        point.slope[1] += along_y.first[j] * value;
        point.curvature[0] += along_y.value[j] * sum(along_x.second);
        point.curvature[1] += along_y.second[j] * value;
        point.curvature[2] += along_y.first[j] * first;
    }
    point.slope[0] /= spacing_[0];
    point.slope[1] /= spacing_[1];
    point.curvature[0] /= spacing_[0] * spacing_[0];
    point.curvature[1] /= spacing_[1] * spacing_[1];
    point.curvature[2] /= spacing_[0] * spacing_[1];
    return point;
}

std::string Terrain::cell_name(double x, double y) const {
    if (is_plane() || place(x, y) == Place::outside) return "";
    const auto nearest = [](const Within& at) { return at.cell + (at.t < 0.5 ? 0 : 1); };
    const std::size_t column = nearest(within(x, lower_[0], spacing_[0], columns_));
    const std::size_t row = nearest(within(y, lower_[1], spacing_[1], rows_));
    return fmt::format("column {}, row {}", column + 1, rows_ - row);
}

}  // namespace talus
