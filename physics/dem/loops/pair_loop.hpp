#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <experimental/simd>
#include <limits>
#include <stdexcept>

#include "physics/dem/contact_pass.hpp"

namespace talus::dem {

/// The pairs of [begin, end) whose gap is below `reach` are put to `found`, which has room for a set of lanes
/// more; returns how many they are.
inline std::size_t find_touching(const GrainRows& rows, double reach, const ContactList& list,
                                 std::size_t begin, std::size_t end, std::uint32_t* found) {
    std::array<std::uint32_t, lane_count> pair;
    GrainRows::Pointers a, b;
    std::size_t count = 0;
    for (std::size_t k = begin; k < end; k += lane_count) {
        for (std::size_t lane = 0; lane < lane_count; ++lane) {
            const std::size_t p = std::min(k + lane, end - 1);
            pair[lane] = static_cast<std::uint32_t>(p);
            a[lane] = rows[list.first[p]];
            b[lane] = rows[list.second[p]];
        }
        Vector3<Lanes> xa, xb;
        Lanes radius_a, radius_b;
        load_two(a, 0, xa.x, xa.y);
        load_two(a, 2, xa.z, radius_a);
        load_two(b, 0, xb.x, xb.y);
        load_two(b, 2, xb.z, radius_b);
        const Vector3<Lanes> r = xa - xb;
        const Lanes limit = radius_a + radius_b + reach;
        Lanes excess = dot(r, r) - limit * limit;
        if (k + lane_count > end) excess = select(first_lanes(end - k), excess, Lanes(1.0));
        count += keep_negative(excess, pair.data(), found + count);
    }
    return count;
}

/// A vector in whole units, narrowing `bearable` to the lanes that are within range.
using Units = std::array<IntegerLanes, 3>;
inline Units in_units(const Vector3<Lanes>& vector, const Lanes& units_per_force, LaneMask& bearable) {
    const auto whole = [&](const Lanes& component) {
        const Lanes scaled = component * units_per_force;
        bearable = bearable && abs(scaled) < most_units;
        return std::experimental::static_simd_cast<IntegerLanes>(scaled);
    };
    return {whole(vector.x), whole(vector.y), whole(vector.z)};
}

/// The contacts of a list, as many at once as there are lanes.
template <class Table>
class PairLoop {
  public:
    static constexpr std::size_t history_count = Table::Law::history_count;
    static_assert(history_count <= most_history);

    PairLoop(const Evaluation& evaluation, const Table& table, double reach, ContactList& list)
        : evaluation_(evaluation),
          table_(table),
          list_(list),
          reach_(reach),
          only_law_(in_all_lanes<typename Table::LawOfLanes>(table.pairs[0])) {}

    /// Chunk after chunk, so that the contacts find in the cache what the search has read.
    Overload operator()(Pairs which) {
        const bool own = which == Pairs::own;
        const std::size_t last_class = list_.class_of(reach_ + evaluation_.approach);
        const std::size_t end = own ? list_.own_chunks : list_.chunks.size();
        for (std::size_t c = own ? 0 : list_.own_chunks; c < end; ++c) {
            ContactList::Chunk& chunk = list_.chunks[c];
            if (own) evaluation_.make_ready(chunk.grains);
            take_former(chunk);
            const std::size_t count = find_touching(evaluation_.rows, reach_, list_, chunk.begin,
                                                    chunk.begin + chunk.up_to[last_class], found_.data());
            list_.make_room(chunk, count);
            chunk.contacts = static_cast<std::uint32_t>(count);
            for (std::size_t k = 0; k < count; ++k)
                list_.pair[chunk.place + k] = static_cast<std::uint16_t>(found_[k] - chunk.begin);
            for (std::size_t k = 0; k < count; k += lane_count)
                contacts(chunk, k, std::min(lane_count, count - k));
        }
        return overload_;
    }

  private:
    static constexpr std::size_t most = ContactList::chunk_size + lane_count;

    /// Sets aside the contacts of a chunk at the last evaluation, with an end behind them that remembers
    /// nothing.
    void take_former(const ContactList::Chunk& chunk) {
        former_count_ = chunk.contacts;
        at_former_ = 0;
        for (std::size_t k = 0; k < former_count_; ++k)
            former_pair_[k] = chunk.begin + list_.pair[chunk.place + k];
        former_pair_[former_count_] = std::numeric_limits<std::uint32_t>::max();
        for (std::size_t c = 0; c < history_count; ++c) {
            std::copy_n(list_.history[c].begin() + chunk.place, former_count_, former_history_[c].begin());
            former_history_[c][former_count_] = 0;
        }
    }

    /// Works on `count` contacts that were found in a chunk, from `begin` on. Flat: vectors of lanes that are
    /// handed to functions go through memory.
    [[gnu::flatten]] void contacts(const ContactList::Chunk& chunk, std::size_t begin, std::size_t count) {
        std::array<std::uint32_t, lane_count> pair;
        GrainRows::Pointers rows_a, rows_b;
        SumPointers sums_a, sums_b;
        const auto own = static_cast<std::uint32_t>(evaluation_.sums.size() - 1);
        for (std::size_t lane = 0; lane < lane_count; ++lane) {
            pair[lane] = found_[begin + std::min(lane, count - 1)];
            const std::uint32_t i = list_.first[pair[lane]], j = list_.second[pair[lane]];
            rows_a[lane] = evaluation_.rows[i];
            rows_b[lane] = evaluation_.rows[j];
            const bool counts = lane < count;
            sums_a[lane] = evaluation_.sums[counts ? std::min(i, own) : own].force;
            sums_b[lane] = evaluation_.sums[counts ? std::min(j, own) : own].force;
        }
        const PlacedGrain<Lanes> a = placed_grain(rows_a), b = placed_grain(rows_b);
        const Vector3<Lanes> separation = a.position - b.position;
        const ContactKinematics<Lanes> k =
            grain_kinematics(separation, norm(separation), a.grain, b.grain, Lanes(evaluation_.time_step));

        std::array<Lanes, history_count> history = remembered(pair);
        const ContactLoad<Lanes> load =
            table_.pairs.materials() == 1 ? only_law_(k, history) : law_of(pair)(k, history);
        for (std::size_t c = 0; c < history_count; ++c)
            history[c].copy_to(list_.history[c].data() + chunk.place + begin,
                               std::experimental::element_aligned);

        LaneMask bearable = first_lanes(lane_count);
        const ContactLoad<Lanes> opposite{-load.force, -load.couple};
        const Lanes inverse = 1 / (a.grain.radius * b.grain.radius);
        add(sums_a, in_units(load.force, a.units_per_force, bearable),
            in_units(torque_about_centre(k.normal, contact_arm(a.grain.radius, k.overlap), load),
                     a.units_per_force * (b.grain.radius * inverse), bearable));
        add(sums_b, in_units(opposite.force, b.units_per_force, bearable),
            in_units(torque_about_centre(-k.normal, contact_arm(b.grain.radius, k.overlap), opposite),
                     b.units_per_force * (a.grain.radius * inverse), bearable));
        if (all_of(bearable) || overload_.found) return;
        const std::uint32_t p = pair[static_cast<std::size_t>(find_first_set(!bearable))];
        overload_ = {true, list_.first[p], list_.second[p], false};
    }

    /// What pairs that touched at the last evaluation remember; zeros of the others.
    std::array<Lanes, history_count> remembered(const std::array<std::uint32_t, lane_count>& pair) {
        std::array<std::size_t, lane_count> from;
        bool in_sequence = true;
        for (std::size_t lane = 0; lane < lane_count; ++lane) {
            while (former_pair_[at_former_] < pair[lane]) ++at_former_;
            from[lane] = former_pair_[at_former_] == pair[lane] ? at_former_ : former_count_;
            in_sequence = in_sequence && from[lane] == from[0] + lane;
        }
        std::array<Lanes, history_count> history;
        for (std::size_t c = 0; c < history_count; ++c) {
            const double* values = former_history_[c].data();
            history[c] = in_sequence ? talus::load(values + from[0])
                                     : Lanes([&](auto lane) { return values[from[lane]]; });
        }
        return history;
    }

    typename Table::LawOfLanes law_of(const std::array<std::uint32_t, lane_count>& pair) const {
        std::array<std::size_t, lane_count> index;
        for (std::size_t lane = 0; lane < lane_count; ++lane)
            index[lane] = table_.pairs.index(evaluation_.rows.material(list_.first[pair[lane]]),
                                             evaluation_.rows.material(list_.second[pair[lane]]));
        return gather<typename Table::LawOfLanes>(table_.pairs, index);
    }

    using SumPointers = std::array<std::int64_t*, lane_count>;
    static void add(const SumPointers& sums, const Units& force, const Units& torque) {
        add_two(sums, 0, force[0], force[1]);
        add_two(sums, 2, force[2], torque[0]);
        add_two(sums, 4, torque[1], torque[2]);
    }

    const Evaluation& evaluation_;
    const Table& table_;
    ContactList& list_;
    double reach_;
    std::array<std::uint32_t, most> found_;        ///< pairs of the chunk that touch
    std::array<std::uint32_t, most> former_pair_;  ///< of its contacts at the last evaluation
    std::array<std::array<double, most>, history_count> former_history_;
    std::size_t former_count_ = 0;
    std::size_t at_former_ = 0;  ///< the contact of these that may be the next to be found again
    Overload overload_;
    typename Table::LawOfLanes only_law_;
};

template <class Elasticity, class SurfaceForce>
Overload evaluate_family(const Evaluation& evaluation, const AnyLawTable& laws, Pairs which,
                         ContactList& list) {
    const auto loop = [&]<class Table>(const Table& table) -> Overload {
        if constexpr (is_of_family<Elasticity, SurfaceForce, Table>)
            return PairLoop(evaluation, table, greatest_reach(laws, evaluation.largest_radius), list)(which);
        else
            throw std::logic_error("a law of another family");
    };
    return std::visit(loop, laws);
}

}  // namespace talus::dem
