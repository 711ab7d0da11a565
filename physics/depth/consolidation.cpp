#include "physics/depth/consolidation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace talus::depth {

namespace {

constexpr std::size_t block = 32;          // particles whose equations are solved side by side
constexpr double almost_infinite = 1e100;  // for columns without depth
using Row = std::array<double, block>;

}  // namespace

void consolidate_first_mode(const Consolidation& law, const LoadedColumns& columns, double time_step,
                            std::span<double> bed_pressure) {
    const double rate = std::numbers::pi * std::numbers::pi / 4 * law.coefficient * time_step;
    for (std::size_t i = 0; i < bed_pressure.size(); ++i) {
        const double depth = columns.depth[i];
        const double loaded = bed_pressure[i] + (columns.load_after[i] - columns.load_before[i]);
        bed_pressure[i] = depth > 0 ? std::max(loaded, 0.0) * std::exp(-rate / (depth * depth)) : 0.0;
    }
}

void consolidate_profile(const Consolidation& law, const LoadedColumns& columns, double time_step,
                         std::span<double* const> pressure) {
    const std::size_t points = pressure.size();
    const auto count = static_cast<double>(points);
    // Thomas's algorithm for -r p[k-1] + (1 + 2r) p[k] - r p[k+1] = p_before[k]; beyond the surface p = 0,
    // and beyond an impermeable bed p mirrors, which doubles the first row's upper coefficient.
    const double first_coupling = law.base == Base::impermeable ? 2 : 0;
    std::vector<Row> upper(points);
    Row ratio, gained;
    for (std::size_t first = 0; first < columns.depth.size(); first += block) {
        const std::size_t lanes = std::min(block, columns.depth.size() - first);
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            const double depth = columns.depth[first + lane];
            gained[lane] = columns.load_after[first + lane] - columns.load_before[first + lane];
            ratio[lane] =
                std::min(almost_infinite, law.coefficient * time_step * count * count / (depth * depth));
        }
        for (std::size_t k = 0; k < points; ++k) {
            double* p = pressure[k] + first;
            const double share = 1 - static_cast<double>(k) / count;
            if (k == 0 && law.base == Base::drained) {
                std::fill_n(p, lanes, 0.0);
                upper[0].fill(0);
                continue;
            }
            const double* below = k > 0 ? pressure[k - 1] + first : nullptr;
            for (std::size_t lane = 0; lane < lanes; ++lane) {
                const double r = ratio[lane], loaded = std::max(p[lane] + gained[lane] * share, 0.0);
                if (k == 0) {
                    const double pivot = 1 / (1 + 2 * r);
                    upper[0][lane] = -first_coupling * r * pivot;
                    p[lane] = loaded * pivot;
                } else {
                    const double pivot = 1 / (1 + 2 * r + r * upper[k - 1][lane]);
                    upper[k][lane] = -r * pivot;
                    p[lane] = (loaded + r * below[lane]) * pivot;
                }
            }
        }
        for (std::size_t k = points - 1; k-- > 0;)
            for (std::size_t lane = 0; lane < lanes; ++lane)
                pressure[k][first + lane] -= upper[k][lane] * pressure[k + 1][first + lane];
    }
}

void set_pore_pressure(double ratio, std::span<const double> load, std::span<double* const> pressure) {
    for (std::size_t k = 0; k < pressure.size(); ++k) {
        const double share = 1 - static_cast<double>(k) / static_cast<double>(pressure.size());
        for (std::size_t i = 0; i < load.size(); ++i) pressure[k][i] = ratio * load[i] * share;
    }
}

}  // namespace talus::depth
