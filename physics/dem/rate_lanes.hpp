#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "domain/lanes.hpp"
#include "physics/dem/force_sum.hpp"

namespace talus::dem {

/// Accelerations along x, y, z, then angular accelerations.
using LanesOfRates = std::array<Lanes, 6>;

/// The six values of `count` records from `i` on, whole numbers or rates; zeros in the other lanes.
inline LanesOfRates load_rates(std::span<const ForceSum> records, std::size_t i, std::size_t count) {
    static_assert(sizeof(ForceSum) == 6 * sizeof(double));
    static const ForceSum none{};
    std::array<const double*, lane_count> from;
    for (std::size_t lane = 0; lane < lane_count; ++lane)
        from[lane] = reinterpret_cast<const double*>(lane < count ? &records[i + lane] : &none);
    LanesOfRates values;
    for (std::size_t c = 0; c < values.size(); c += 2) load_two(from, c, values[c], values[c + 1]);
    return values;
}

/// The reverse.
inline void store_rates(std::span<ForceSum> records, std::size_t i, std::size_t count,
                        const LanesOfRates& values) {
    ForceSum none;
    std::array<double*, lane_count> to;
    for (std::size_t lane = 0; lane < lane_count; ++lane)
        to[lane] = reinterpret_cast<double*>(lane < count ? &records[i + lane] : &none);
    for (std::size_t c = 0; c < values.size(); c += 2) store_two(to, c, values[c], values[c + 1]);
}

}  // namespace talus::dem
