#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "domain/cell_table.hpp"
#include "domain/lanes.hpp"

namespace talus {

/// Boxes around every eight particles that lie one after the other in memory, and their largest reach: where
/// radii differ much, a search that asks them first passes over most particles within the largest radius.
template <int D>
class ParticleBlocks {
  public:
    static constexpr std::uint32_t size = 8;  ///< particles in a block

    /// `position`: D component arrays of `count` particles, `reach` their radii times `range`.
    void build(const std::array<const double*, D>& position, const double* radius, double range,
               std::size_t count) {
        const std::size_t blocks = (count + size - 1) / size;
        for (int d = 0; d < D; ++d) {
            lower_[d].resize(blocks);
            upper_[d].resize(blocks);
        }
        reach_.resize(blocks);
        near_.resize(blocks + lane_count);
        for (std::size_t b = 0; b < blocks; ++b) {
            const std::size_t begin = b * size, end = std::min(begin + size, count);
            for (int d = 0; d < D; ++d) {
                const auto [least, greatest] = std::minmax_element(position[d] + begin, position[d] + end);
                lower_[d][b] = *least;
                upper_[d][b] = *greatest;
            }
            reach_[b] = range * *std::max_element(radius + begin, radius + end);
        }
    }

    /// Calls visit(run) for parts of `run` in order that hold all its particles within their own reach, or
    /// `reach`, of a box.
    template <class Visit>
    void for_each_near(const Run& run, const std::array<double, D>& lower, const std::array<double, D>& upper,
                       double reach, Visit&& visit) {
        const std::uint32_t last = (run.end + size - 1) / size;
        std::array<std::uint32_t, lane_count> place;
        std::size_t found = 0;
        for (std::uint32_t b = run.begin / size; b < last; b += lane_count) {
            for (std::uint32_t lane = 0; lane < lane_count; ++lane) place[lane] = b + lane;
            const std::size_t left = last - b;
            Lanes apart2 = 0;
            for (int d = 0; d < D; ++d) {
                const Lanes apart = max(max(lower[d] - load_first(upper_[d].data() + b, left),
                                            load_first(lower_[d].data() + b, left) - upper[d]),
                                        Lanes(0.0));
                apart2 += apart * apart;
            }
            const Lanes radius = max(load_first(reach_.data() + b, left), Lanes(reach));
            Lanes excess = apart2 - radius * radius;
            if (left < lane_count) excess = select(first_lanes(left), excess, Lanes(1.0));
            found += keep_negative(excess, place.data(), near_.data() + found);
        }
        for (std::size_t k = 0; k < found; ++k)
            visit(Run{std::max(run.begin, near_[k] * size), std::min(run.end, (near_[k] + 1) * size)});
    }

  private:
    std::array<std::vector<double>, D> lower_, upper_;
    std::vector<double> reach_;
    std::vector<std::uint32_t> near_;
};

}  // namespace talus
