#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "domain/cell_table.hpp"
#include "domain/lanes.hpp"
#include "domain/partners.hpp"

namespace talus::water {

/// Values of particles side by side, the same value of one after the other in memory, in canonical order;
/// behind the last one, up to a whole number of lanes, particles too far away to matter.
template <std::size_t count>
class Block {
  public:
    void clear(std::size_t most) {
        for (AlignedValues& column : columns_) column.reserve(most + 2 * lane_count);
        size_ = 0;
    }
    /// Appends those of a set of lanes for which `sign` is negative.
    void append(const Lanes& sign, const std::array<Lanes, count>& values) {
        std::size_t number = 0;
        for (std::size_t c = 0; c < count; ++c)
            number = keep_negative(sign, values[c], columns_[c].data() + size_);
        size_ += number;
    }
    void pad(const std::array<double, count>& nobody) {
        for (std::size_t c = 0; c < count; ++c) std::fill_n(columns_[c].data() + size_, lane_count, nobody[c]);
    }
    std::size_t size() const { return size_; }
    const double* column(std::size_t c) const { return columns_[c].data(); }

  private:
    std::array<AlignedValues, count> columns_;
    std::size_t size_ = 0;
};

/// Where particles are that fill up lanes: no kernel reaches there [m].
inline constexpr double far_away = 1e100;

/// The smallest box around the particles of one cell.
template <int D>
struct Around {
    std::array<double, D> lower, upper;

    Around(const CellEntry& cell, const std::array<const double*, D>& position) {
        for (int d = 0; d < D; ++d) {
            const auto [least, greatest] =
                std::minmax_element(position[d] + cell.begin, position[d] + cell.end);
            lower[d] = *least;
            upper[d] = *greatest;
        }
    }
    Lanes distance2(const std::array<Lanes, D>& x) const {
        Lanes sum = 0;
        for (int d = 0; d < D; ++d) {
            const Lanes outside = max(max(lower[d] - x[d], x[d] - upper[d]), Lanes(0.0));
            sum += outside * outside;
        }
        return sum;
    }
};

/// Calls visit(k, number, x, excess) for all lanes of the runs' particles, k the first of `number` of them at
/// places x, that are not all farther than `reach` from the box around a cell's particles: those are for which
/// `excess` is not negative.
template <int D, class Visit>
void for_each_near(const CellEntry& cell, std::span<const Run> runs,
                   const std::array<const double*, D>& position, double reach, Visit&& visit) {
    const Around<D> around(cell, position);
    for (const Run& run : runs)
        for (std::uint32_t k = run.begin; k < run.end; k += lane_count) {
            const std::size_t number = run.end - k;
            std::array<Lanes, D> x;
            for (int d = 0; d < D; ++d) x[d] = load_first(position[d] + k, number);
            Lanes excess = around.distance2(x) - reach * reach;
            if (number < lane_count) excess = select(first_lanes(number), excess, Lanes(1.0));
            if (any_of(excess < 0)) visit(k, number, x, excess);
        }
}

inline std::size_t count_of(std::span<const Run> runs) {
    std::size_t count = 0;
    for (const Run& run : runs) count += run.end - run.begin;
    return count;
}

}  // namespace talus::water
