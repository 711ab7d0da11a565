#include "domain/terrain_smoothing.hpp"

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace talus {

namespace {

/// Means along a line of values that lie `stride` apart.
void smooth_line(double* first, std::size_t count, std::size_t stride, const std::vector<double>& weights) {
    std::vector<double> line(count);
    for (std::size_t k = 0; k < count; ++k) line[k] = first[k * stride];
    for (std::size_t k = 0; k < count; ++k) {
        if (std::isnan(line[k])) continue;
        double sum = weights[0] * line[k], all = weights[0];
        for (std::size_t away = 1; away < weights.size() && away <= k && k + away < count; ++away) {
            const double pair = line[k - away] + line[k + away];
            if (std::isnan(pair)) continue;
            sum += weights[away] * pair;
            all += 2 * weights[away];
        }
        first[k * stride] = sum / all;
    }
}

std::vector<double> falling_weights(double length_in_spacings) {
    std::vector<double> weights{1};
    for (double away = 1; away < length_in_spacings; ++away) weights.push_back(1 - away / length_in_spacings);
    return weights;
}

}  // namespace

TerrainGrid smoothed(TerrainGrid grid, double length) {
    const std::vector<double> along_x = falling_weights(length / grid.spacing[0]),
                              along_y = falling_weights(length / grid.spacing[1]);
    for (std::size_t row = 0; row < grid.rows; ++row)
        smooth_line(grid.elevations.data() + row * grid.columns, grid.columns, 1, along_x);
    for (std::size_t column = 0; column < grid.columns; ++column)
        smooth_line(grid.elevations.data() + column, grid.rows, grid.columns, along_y);
    return grid;
}

}  // namespace talus
