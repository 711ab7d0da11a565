#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "domain/cell_table.hpp"
#include "domain/float_lanes.hpp"
#include "domain/partners.hpp"

namespace talus::water {

/// Values of particles side by side, the same value of one after the other in memory, in canonical order;
/// behind the last one, up to a whole number of lanes, particles too far away to matter. The first values are
/// the place.
template <std::size_t count>
class Block {
  public:
    void clear(std::size_t most) {
        room_ = (most + 2 * float_lane_count) / float_lane_count * float_lane_count;
        values_.reserve(count * room_);
        size_ = 0;
    }
    /// Appends those of a set of lanes whose bits are set.
    void append(LaneBits bits, const std::array<FloatLanes, count>& values) {
        float* to = values_.data() + size_;
        for (std::size_t c = 0; c < count; ++c) store_lanes(bits, values[c], to + c * room_);
        size_ += static_cast<std::size_t>(std::popcount(bits));
    }
    void pad() {
        constexpr float far_away = 1e4F;  // in radii
        for (std::size_t c = 0; c < count; ++c)
            std::fill_n(values_.data() + c * room_ + size_, float_lane_count, c == 0 ? far_away : 0);
    }
    std::size_t size() const { return size_; }
    std::array<const float*, count> columns() const {
        std::array<const float*, count> pointers;
        for (std::size_t c = 0; c < count; ++c) pointers[c] = values_.data() + c * room_;
        return pointers;
    }

  private:
    AlignedArray<float> values_;
    std::size_t room_ = 0, size_ = 0;
};

/// Places in units of the radius of interaction, relative to a particle of a cell.
template <int D>
class LocalFrame {
  public:
    LocalFrame(const std::array<const double*, D>& position, double radius)
        : position_(position), inverse_radius_(1 / radius) {}

    void enter(const CellEntry& cell) {
        for (int d = 0; d < D; ++d) {
            const auto [least, greatest] =
                std::minmax_element(position_[d] + cell.begin, position_[d] + cell.end);
            origin_[d] = *least;
            extent_[d] = static_cast<float>((*greatest - *least) * inverse_radius_);
        }
    }
    float place(int axis, std::uint32_t i) const {
        return static_cast<float>((position_[axis][i] - origin_[axis]) * inverse_radius_);
    }
    /// Of particles k to k + number - 1, at most one in each lane.
    std::array<FloatLanes, D> places(std::uint32_t k, std::size_t number) const {
        std::array<FloatLanes, D> x;
        for (int d = 0; d < D; ++d) {
            const double* from = position_[d] + k;
            const Lanes low = (load_first(from, number) - origin_[d]) * inverse_radius_;
            const Lanes high =
                number > lane_count
                    ? (load_first(from + lane_count, number - lane_count) - origin_[d]) * inverse_radius_
                    : Lanes(0.0);
            x[d] = narrowed(low, high);
        }
        return x;
    }
    /// Calls visit(k, number, x, bits) for all lanes of the runs' particles, k the first of `number` of them,
    /// at places x, of which some are wanted and within reach of the box around the cell's particles: those
    /// whose bits are set. `wanted(k, number)` tells which are, by bits.
    template <class Wanted, class Visit>
    void for_each_near(std::span<const Run> runs, Wanted&& wanted, Visit&& visit) const {
        constexpr float reach2 = 1.00001F;  // rounding must leave out nobody
        for (const Run& run : runs)
            for (std::uint32_t k = run.begin; k < run.end; k += float_lane_count) {
                const std::size_t number = run.end - k;
                LaneBits bits = wanted(k, number);
                if (bits == 0) continue;
                const std::array<FloatLanes, D> x = places(k, number);
                FloatLanes excess = -reach2;
                for (int d = 0; d < D; ++d) {
                    const FloatLanes outside = max(max(-x[d], x[d] - extent_[d]), FloatLanes(0.0F));
                    excess += outside * outside;
                }
                bits &= negative_lanes(excess);
                if (number < float_lane_count) bits &= (LaneBits{1} << number) - 1;
                if (bits != 0) visit(k, number, x, bits);
            }
    }

  private:
    std::array<const double*, D> position_;
    double inverse_radius_;
    std::array<double, D> origin_{};
    std::array<float, D> extent_{};
};

inline std::size_t count_of(std::span<const Run> runs) {
    std::size_t count = 0;
    for (const Run& run : runs) count += run.end - run.begin;
    return count;
}

/// Fills a block with the water near a cell, whose `volume` is positive, walls left out: places, then what
/// put(k, number, values) adds of particles k to k + number - 1.
template <int D, std::size_t count, class Put>
void gather_water(LocalFrame<D>& frame, const CellEntry& cell, std::span<const Run> runs, const float* volume,
                  Block<count>& block, Put&& put) {
    frame.enter(cell);
    block.clear(count_of(runs));
    const auto is_water = [volume](std::uint32_t k, std::size_t number) {
        return negative_lanes(-load_first(volume + k, number));
    };
    frame.for_each_near(
        runs, is_water,
        [&](std::uint32_t k, std::size_t number, const std::array<FloatLanes, D>& x, LaneBits bits) {
            std::array<FloatLanes, count> values;
            std::copy(x.begin(), x.end(), values.begin());
            put(k, number, values);
            block.append(bits, values);
        });
    block.pad();
}

}  // namespace talus::water
