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
#include "domain/single_lanes.hpp"

namespace talus::sph {

/// What a pair loop reads of one particle, side by side in memory: a partner costs a few cache lines, not one
/// for each of its values.
template <std::size_t count>
struct alignas(32) PairRecord {
    std::array<double, count + count % 2> values;  // read and written two at a time
};

enum class Precision { full, difference, cell };

template <std::size_t count>
struct alignas(16) SingleRecord {
    std::array<double, 4> position;
    std::array<float, (count + 3) / 4 * 4> values;
};
template <std::size_t count>
struct alignas(16) CellRecord {
    std::array<float, (count + 3) / 4 * 4> values;
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
template <std::size_t count, Precision precision = Precision::full, std::size_t D = 3>
class PairRecords {
  public:
    static constexpr bool single = precision != Precision::full;
    static constexpr std::size_t behind = single ? count - D : count;
    using Real = std::conditional_t<single, SingleLanes, Lanes>;
    using Record = std::conditional_t<
        precision == Precision::full, PairRecord<count>,
        std::conditional_t<precision == Precision::cell, CellRecord<behind>, SingleRecord<behind>>>;

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
        records_ = std::make_unique_for_overwrite<Record[]>(ring_ + copies_);
        if constexpr (precision == Precision::cell)
            relative_ = std::make_unique_for_overwrite<CellRecord<D>[]>(own_ + particles.halo_size());
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
    void enter(std::span<const Run> runs, Finish&& finish, std::uint32_t origin_of = 0) {
        if constexpr (precision == Precision::cell) {
            std::array<Lanes, 4> origin{}, x{};
            for (std::size_t d = 0; d < D; ++d) origin[d] = columns_[d][origin_of];
            for (const Run& run : runs)
                for (std::uint32_t k = run.begin; k < run.end; k += lane_count) {
                    const Neighbours some{k, std::min<std::size_t>(run.end - k, lane_count)};
                    std::array<float*, lane_count> to;
                    std::array<CellRecord<D>, lane_count> spare;
                    for (std::size_t lane = 0; lane < lane_count; ++lane)
                        to[lane] = (lane < some.number ? relative_[k + lane] : spare[lane]).values.data();
                    for (std::size_t d = 0; d < D; ++d) x[d] = some.of(columns_[d]) - origin[d];
                    store_four(to, 0, x.data());
                }
        }
        const std::uint32_t end = own_window(runs).end;
        for (; next_ < needed_.size(); ++next_) {
            Run& rest = needed_[next_];
            while (rest.begin < std::min(rest.end, end)) fill_some(rest, finish);
            if (rest.begin < rest.end) return;
        }
    }

    const Record& operator[](std::uint32_t k) const { return records_[slot(k)]; }

    std::array<Real, count> own(std::uint32_t i) const {
        if constexpr (!single) {
            return broadcast((*this)[i]);
        } else {
            std::array<Real, count> lanes;
            for (std::size_t c = D; c < count; ++c) lanes[c] = Real((*this)[i].values[c - D]);
            for (std::size_t d = 0; d < D; ++d) {
                if constexpr (precision == Precision::cell)
                    lanes[d] = Real(relative_[i].values[d]);
                else
                    lanes[d] = 0.0;
            }
            return lanes;
        }
    }

    /// The records of as many particles as there are lanes, one in each, as seen from i.
    std::array<Real, count> gather(std::uint32_t i, const std::uint32_t* index) const {
        if constexpr (!single) {
            std::array<Lanes, count> lanes;
            std::array<const double*, lane_count> from;
            for (std::size_t lane = 0; lane < lane_count; ++lane)
                from[lane] = (*this)[index[lane]].values.data();
            Lanes none;
            [&]<std::size_t... pair>(std::index_sequence<pair...>) {
                (load_two(from, 2 * pair, lanes[2 * pair], 2 * pair + 1 < count ? lanes[2 * pair + 1] : none),
                 ...);
            }
            (std::make_index_sequence<(count + 1) / 2>{});
            return lanes;
        } else {
            std::array<Real, D + (behind + 3) / 4 * 4> lanes;
            std::array<const float*, SingleLanes::count> from;
            for (std::size_t lane = 0; lane < from.size(); ++lane)
                from[lane] = (*this)[index[lane]].values.data();
            [&]<std::size_t... four>(std::index_sequence<four...>) {
                (load_four(from, 4 * four, lanes.data() + D + 4 * four), ...);
            }
            (std::make_index_sequence<(behind + 3) / 4>{});
            if constexpr (precision == Precision::difference) {
                std::array<const double*, lane_count> low, high;
                for (std::size_t lane = 0; lane < lane_count; ++lane) {
                    low[lane] = (*this)[index[lane]].position.data();
                    high[lane] = (*this)[index[lane + lane_count]].position.data();
                }
                std::array<Lanes, 4> x_low, x_high;
                for (std::size_t pair = 0; pair < (D + 1) / 2; ++pair) {
                    load_two(low, 2 * pair, x_low[2 * pair], x_low[2 * pair + 1]);
                    load_two(high, 2 * pair, x_high[2 * pair], x_high[2 * pair + 1]);
                }
                const auto& x = (*this)[i].position;
                for (std::size_t d = 0; d < D; ++d) lanes[d] = SingleLanes(x_low[d] - x[d], x_high[d] - x[d]);
            } else {
                for (std::size_t lane = 0; lane < from.size(); ++lane)
                    from[lane] = relative_[index[lane]].values.data();
                std::array<Real, 4> x;
                load_four(from, 0, x.data());
                for (std::size_t d = 0; d < D; ++d) lanes[d] = x[d];
            }
            std::array<Real, count> used;
            std::copy_n(lanes.begin(), count, used.begin());
            return used;
        }
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
        std::array<Lanes, count + 4> values;
        for (std::size_t c = 0; c < count; ++c)
            if (columns_[c]) values[c] = some.of(columns_[c]);
        for (std::size_t c = count; c < values.size(); ++c) values[c] = 0;
        finish(some, values);
        std::array<Record, lane_count> spare;  // for lanes without a particle
        const auto record = [&](std::size_t lane) -> Record& {
            return lane < some.number ? records_[slot(some.first + static_cast<std::uint32_t>(lane))]
                                      : spare[lane];
        };
        if constexpr (!single) {
            std::array<double*, lane_count> to;
            for (std::size_t lane = 0; lane < lane_count; ++lane) to[lane] = record(lane).values.data();
            for (std::size_t c = 0; c < count; c += 2) store_two(to, c, values[c], values[c + 1]);
        } else {
            if constexpr (precision == Precision::difference) {
                std::array<double*, lane_count> to;
                for (std::size_t lane = 0; lane < lane_count; ++lane) to[lane] = record(lane).position.data();
                for (std::size_t d = 0; d < D; d += 2) store_two(to, d, values[d], values[d + 1]);
            }
            std::array<float*, lane_count> to;
            for (std::size_t lane = 0; lane < lane_count; ++lane) to[lane] = record(lane).values.data();
            for (std::size_t c = D; c < count; c += 4) store_four(to, c - D, values.data() + c);
        }
        rest.begin += static_cast<std::uint32_t>(some.number);
    }

    std::array<const double*, count> columns_{};
    std::uint32_t own_, ring_ = 1;
    std::vector<Run> needed_;  ///< own particles still to be filled
    std::size_t next_ = 0;     ///< in needed_
    std::size_t copies_ = 0;
    std::unique_ptr<Record[]> records_;
    std::unique_ptr<CellRecord<D>[]> relative_;
};

}  // namespace talus::sph
