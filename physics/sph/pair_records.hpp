#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "domain/cell_table.hpp"
#include "domain/lanes.hpp"
#include "domain/particles.hpp"

namespace talus::sph {

/// What a pair loop reads of one particle, side by side in memory: a partner costs a few cache lines, not one
/// for each of its values.
template <std::size_t count>
struct alignas(32) PairRecord {
    std::array<double, count + count % 2> values;  // read and written two at a time
};

/// Particles that lie one after the other, no more than there are lanes: their records are made at once.
struct Neighbours {
    std::uint32_t first;
    std::size_t number;

    /// Their values of a field's component; zeros behind them.
    Lanes of(const double* component) const { return load_first(component + first, number); }
};

/// One record in every lane.
template <std::size_t count>
std::array<Lanes, count> broadcast(const PairRecord<count>& record) {
    std::array<Lanes, count> lanes;
    for (std::size_t c = 0; c < count; ++c) lanes[c] = record.values[c];
    return lanes;
}

/// The records of those particles that the cells being visited can reach: of own particles a window that
/// moves through the set as cells are visited in order, kept in a ring; of copies all.
template <std::size_t count>
class PairRecords {
  public:
    PairRecords(const ParticleSet& particles, const CellTable& table, Cells which)
        : own_(static_cast<std::uint32_t>(particles.size())) {
        std::uint32_t longest = 1,
                      filled = 0;  // windows do not begin in order: a row of cells may be missing
        bool any = false;
        std::vector<std::int32_t> begun;  // runs begun less runs ended at each particle
        if (which == Cells::boundary) begun.assign(std::size_t{own_} + 1, 0);
        table.for_each_own(which, [&](const CellEntry&, std::span<const Run> runs, std::size_t) {
            const Run window = own_window(runs);
            filled = std::max(filled, window.end);
            if (window.begin < window.end) longest = std::max(longest, filled - window.begin);
            any = true;
            if (begun.empty()) return;
            for (const Run& run : runs) {
                if (run.begin >= own_) continue;
                ++begun[run.begin];
                --begun[std::min(run.end, own_)];
            }
        });
        list_needed(begun);
        ring_ = std::bit_ceil(longest + static_cast<std::uint32_t>(lane_count));  // see enter()
        copies_ = any && which != Cells::interior ? particles.halo_size() : 0;
        records_ = std::make_unique_for_overwrite<PairRecord<count>[]>(ring_ + copies_);
    }

    /// Values from `place` on are copied from these component arrays.
    template <std::size_t components>
    void copy(std::size_t place, const std::array<const double*, components>& from) {
        for (std::size_t c = 0; c < components; ++c) columns_[place + c] = from[c];
    }
    /// Fills the records of the copies; finish(neighbours, values) sets what is not copied, a particle in
    /// each lane.
    template <class Finish>
    void fill_copies(Finish&& finish) {
        Run rest{own_, own_ + static_cast<std::uint32_t>(copies_)};
        while (rest.begin < rest.end) fill_some(rest, finish);
    }
    /// Moves the window on to a cell with these runs, or a few particles further. Cells must come in their
    /// order.
    template <class Finish>
    void enter(std::span<const Run> runs, Finish&& finish) {
        const std::uint32_t end = own_window(runs).end;
        for (; next_ < needed_.size(); ++next_) {
            Run& rest = needed_[next_];
            while (rest.begin < std::min(rest.end, end)) fill_some(rest, finish);
            if (rest.begin < rest.end) return;
        }
    }

    const PairRecord<count>& operator[](std::uint32_t k) const { return records_[slot(k)]; }

    /// The records of as many particles as there are lanes, one in each.
    std::array<Lanes, count> gather(const std::uint32_t* index) const {
        std::array<Lanes, count> lanes;
        std::array<const double*, lane_count> from;
        for (std::size_t lane = 0; lane < lane_count; ++lane) from[lane] = (*this)[index[lane]].values.data();
        Lanes none;
        [&]<std::size_t... pair>(std::index_sequence<pair...>) {
            (load_two(from, 2 * pair, lanes[2 * pair], 2 * pair + 1 < count ? lanes[2 * pair + 1] : none),
             ...);
        }
        (std::make_index_sequence<(count + 1) / 2>{});
        return lanes;
    }

  private:
    /// From the first to behind the last own particle in the runs.
    Run own_window(std::span<const Run> runs) const {
        Run window{own_, 0};
        for (const Run& run : runs) {
            if (run.begin >= own_) continue;
            window.begin = std::min(window.begin, run.begin);
            window.end = std::max(window.end, std::min(run.end, own_));
        }
        return window;
    }
    /// The own particles that lie in any run; all if there is nothing to tell.
    void list_needed(const std::vector<std::int32_t>& begun) {
        if (begun.empty()) needed_.push_back({0, own_});
        std::int32_t depth = 0;
        for (std::uint32_t k = 0; k < begun.size(); ++k) {
            const std::int32_t before = depth;
            depth += begun[k];
            if (before == 0 && depth > 0) needed_.push_back({k, k});
            if (before > 0 && depth == 0) needed_.back().end = k;
        }
    }
    std::size_t slot(std::uint32_t k) const { return k < own_ ? k & (ring_ - 1) : ring_ + (k - own_); }

    /// Fills records from rest.begin on, as many as there are lanes if there are, and moves rest.begin.
    template <class Finish>
    void fill_some(Run& rest, Finish& finish) {
        const Neighbours some{rest.begin, std::min<std::size_t>(rest.end - rest.begin, lane_count)};
        std::array<Lanes, count + 1> values;
        for (std::size_t c = 0; c < count; ++c)
            if (columns_[c]) values[c] = some.of(columns_[c]);
        values[count] = 0;
        finish(some, values);
        std::array<PairRecord<count>, lane_count> spare;  // for lanes without a particle
        std::array<double*, lane_count> to;
        for (std::size_t lane = 0; lane < lane_count; ++lane)
            to[lane] = (lane < some.number ? records_[slot(some.first + static_cast<std::uint32_t>(lane))]
                                           : spare[lane])
                           .values.data();
        for (std::size_t c = 0; c < count; c += 2) store_two(to, c, values[c], values[c + 1]);
        rest.begin += static_cast<std::uint32_t>(some.number);
    }

    std::array<const double*, count> columns_{};
    std::uint32_t own_, ring_ = 1;
    std::vector<Run> needed_;  ///< own particles still to be filled
    std::size_t next_ = 0;     ///< in needed_
    std::size_t copies_ = 0;
    std::unique_ptr<PairRecord<count>[]> records_;
};

}  // namespace talus::sph
