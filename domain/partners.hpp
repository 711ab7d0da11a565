#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>
#include <optional>
#include <span>
#include <vector>

#include "domain/cell_table.hpp"
#include "domain/lanes.hpp"
#include "domain/particle_blocks.hpp"

namespace talus {

/// A growing array on a cache-line boundary, for values gathered in front of a pair loop.
template <class Real>
class AlignedArray {
  public:
    AlignedArray() = default;
    AlignedArray(const AlignedArray&) = delete;
    AlignedArray& operator=(const AlignedArray&) = delete;
    ~AlignedArray() { release(); }

    void reserve(std::size_t count) {
        if (count <= capacity_) return;
        release();
        capacity_ = count + count / 2;
        data_ = new (alignment) Real[capacity_];
    }
    Real* data() { return data_; }
    const Real* data() const { return data_; }

  private:
    static constexpr std::align_val_t alignment{64};
    void release() {
        if (data_) ::operator delete[](data_, alignment);
    }
    Real* data_ = nullptr;
    std::size_t capacity_ = 0;
};
using AlignedValues = AlignedArray<double>;

/// The interaction partners of the particles of one cell after another: found exactly (|r| < radius, itself
/// excluded), in canonical order, so that what is summed over them has the same bits on any number of ranks.
/// Particles with a smoothing length of 0 have no partners and must not be asked for theirs.
template <int D>
class Partners {
  public:
    /// `position`: D component arrays, `h`: smoothing lengths, both of own particles and copies; `range`: no
    /// pair will be asked for beyond range * h of either particle.
    Partners(const std::array<const double*, D>& position, const double* h, double range)
        : position_(position), h_(h), range_(range) {}

    /// For radii that differ much: looks for the partners among blocks of the first `count` particles, none
    /// beyond which may be in a run. The same partners in the same order, sooner found.
    void search_by_blocks(std::size_t count) { block_particles_ = count; }

    /// Takes up a cell: lists those of the runs' particles (CellTable) that are within their own reach, or
    /// that of one of the cell's particles, of the box around these.
    void enter(const CellEntry& cell, std::span<const Run> runs) {
        std::size_t count = 0;
        for (const Run& run : runs) count += run.end - run.begin;
        reserve(count);
        list_candidates(cell, runs);
        cell_begin_ = cell.begin;
        const auto place = std::find(candidates_.begin(), candidates_.end(), cell.begin);
        cell_place_ = static_cast<std::size_t>(place - candidates_.begin());
        for (std::size_t k = 0; k < padded(candidate_count_); ++k) {
            const bool real = k < candidate_count_;
            if (!real) candidates_[k] = cell.begin;
            for (int d = 0; d < D; ++d)
                near_position_[d].data()[k] = real ? position_[d][candidates_[k]] : nowhere;
            near_h_.data()[k] = h_[candidates_[k]];
        }
    }

    /// Lists the partners of particle i of the cell within the radius `range` * h_i.
    void find(std::uint32_t i, double range) {
        const double limit2 = range * h_[i] * (range * h_[i]);
        find_if_negative(i, [=](std::size_t, const Lanes& r2) { return r2 - limit2; });
    }
    /// As find() with the larger of the two smoothing lengths.
    void find_mutual(std::uint32_t i, double range) {
        const double h_i = h_[i], *h = near_h_.data();
        find_if_negative(i, [=](std::size_t k, const Lanes& r2) {
            const Lanes radius = range * max(load(h + k), Lanes(h_i));
            return r2 - radius * radius;
        });
    }

    std::size_t count() const { return count_; }
    /// The partners; behind them, up to a multiple of lane_count, the last one is repeated.
    std::span<const std::uint32_t> index() const { return {index_.data(), count_}; }

  private:
    static constexpr double nowhere = std::numeric_limits<double>::infinity();
    static std::size_t padded(std::size_t count) {
        return (count + lane_count - 1) / lane_count * lane_count;
    }

    void reserve(std::size_t count) {
        const std::size_t room = count + 2 * lane_count;
        if (candidates_.size() >= room) return;
        for (int d = 0; d < D; ++d) near_position_[d].reserve(room);
        near_h_.reserve(room);
        candidates_.resize(room);
        index_.resize(room);
    }

    void list_candidates(const CellEntry& cell, std::span<const Run> runs) {
        const double largest = *std::max_element(h_ + cell.begin, h_ + cell.end);
        std::array<double, D> lower, upper;
        for (int d = 0; d < D; ++d) {
            const auto [least, greatest] =
                std::minmax_element(position_[d] + cell.begin, position_[d] + cell.end);
            lower[d] = *least;
            upper[d] = *greatest;
        }
        candidate_count_ = 0;
        const auto list_near = [&](const Run& run) { list_candidates(run, lower, upper, largest); };
        if (block_particles_ > 0 && !blocks_)
            blocks_.emplace().build(position_, h_, range_, block_particles_);
        for (const Run& run : runs) {
            if (blocks_)
                blocks_->for_each_near(run, lower, upper, range_ * largest, list_near);
            else
                list_near(run);
        }
    }

    void list_candidates(const Run& run, const std::array<double, D>& lower,
                         const std::array<double, D>& upper, double largest) {
        std::array<std::uint32_t, lane_count> place;
        for (std::uint32_t k = run.begin; k < run.end; k += lane_count) {
            const std::size_t left = run.end - k;
            for (std::uint32_t lane = 0; lane < lane_count; ++lane) place[lane] = k + lane;
            Lanes outside2 = 0;
            for (int d = 0; d < D; ++d) {
                const Lanes x = load_first(position_[d] + k, left);
                const Lanes outside = max(max(lower[d] - x, x - upper[d]), Lanes(0.0));
                outside2 += outside * outside;
            }
            const Lanes reach = range_ * max(load_first(h_ + k, left), Lanes(largest));
            Lanes excess = outside2 - reach * reach;
            if (left < lane_count) excess = select(first_lanes(left), excess, Lanes(1.0));
            candidate_count_ += keep_negative(excess, place.data(), candidates_.data() + candidate_count_);
        }
    }

    /// Lists the candidates for which excess(k, squared distance) is negative; i itself is out of reach
    /// meanwhile.
    template <class Excess>
    void find_if_negative(std::uint32_t i, Excess&& excess) {
        const std::size_t own = cell_place_ + (i - cell_begin_);
        std::array<Lanes, D> centre;
        std::array<const double*, D> x;
        for (int d = 0; d < D; ++d) {
            x[d] = near_position_[d].data();
            centre[d] = x[d][own];
        }
        const double x_own = x[0][own];
        near_position_[0].data()[own] = nowhere;
        const std::uint32_t* candidates = candidates_.data();
        std::uint32_t* index = index_.data();
        std::size_t count = 0;
        for (std::size_t k = 0; k < candidate_count_; k += lane_count) {
            Lanes r2 = 0;
            for (int d = 0; d < D; ++d) {
                const Lanes r = centre[d] - load(x[d] + k);
                r2 += r * r;
            }
            count += keep_negative(excess(k, r2), candidates + k, index + count);
        }
        near_position_[0].data()[own] = x_own;
        count_ = count;
        for (std::size_t k = count; k < padded(count); ++k) index[k] = index[count - 1];
    }

    std::array<const double*, D> position_;
    const double* h_;
    double range_;
    std::size_t block_particles_ = 0;  ///< 0: no blocks
    std::optional<ParticleBlocks<D>> blocks_;
    std::vector<std::uint32_t> candidates_;  ///< for the particles of the cell, in canonical order
    std::size_t candidate_count_ = 0;
    std::array<AlignedValues, D> near_position_;  ///< of the candidates
    AlignedValues near_h_;
    std::uint32_t cell_begin_ = 0;
    std::size_t cell_place_ = 0;  ///< of the cell's first particle among the candidates
    std::vector<std::uint32_t> index_;
    std::size_t count_ = 0;
};

}  // namespace talus
