#pragma once
#include <algorithm>
#include <array>
#include <experimental/simd>
#include <stdexcept>

#include "physics/dem/contact_pass.hpp"

namespace talus::dem {

/// The pairs of [begin, end) whose gap is below `reach`, appended to the contacts, which have room for them.
inline void find_touching(const GrainRows& rows, double reach, std::size_t begin, std::size_t end,
                          ContactList& list) {
    std::array<std::uint32_t, lane_count> pair;
    GrainRows::Pointers a, b;
    Contacts& contacts = list.now;
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
        contacts.count += keep_negative(excess, pair.data(), contacts.pair.data() + contacts.count);
    }
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
        if (own) {
            std::swap(list_.now, list_.before);
            list_.before.close();
            list_.now.clear();
        }
        const std::size_t last_class = list_.class_of(reach_ + evaluation_.approach);
        std::size_t done = list_.now.count;
        former_ = own ? 0 : first_former_with_copies();
        const std::size_t end = own ? list_.own_chunks : list_.chunks.size();
        for (std::size_t c = own ? 0 : list_.own_chunks; c < end; ++c) {
            const ContactList::Chunk& chunk = list_.chunks[c];
            list_.now.reserve(ContactList::chunk_size);
            find_touching(evaluation_.rows, reach_, chunk.begin, chunk.begin + chunk.up_to[last_class],
                          list_);
            for (; done + lane_count <= list_.now.count; done += lane_count) contacts(done, lane_count);
        }
        if (done < list_.now.count) contacts(done, list_.now.count - done);
        return overload_;
    }

  private:
    std::size_t first_former_with_copies() const {
        const auto begin = list_.before.pair.begin(),
                   end = begin + static_cast<std::ptrdiff_t>(list_.before.count);
        return static_cast<std::size_t>(
            std::lower_bound(begin, end, static_cast<std::uint32_t>(list_.own_count())) - begin);
    }

    /// Works on `count` contacts from `begin` on. Flat: vectors of lanes that are handed to functions go
    /// through memory.
    [[gnu::flatten]] void contacts(std::size_t begin, std::size_t count) {
        std::array<std::uint32_t, lane_count> pair;
        GrainRows::Pointers rows_a, rows_b;
        SumPointers sums_a, sums_b;
        const auto own = static_cast<std::uint32_t>(evaluation_.sums.size() - 1);
        for (std::size_t lane = 0; lane < lane_count; ++lane) {
            pair[lane] = list_.now.pair[begin + std::min(lane, count - 1)];
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
            history[c].copy_to(list_.now.history[c].data() + begin, std::experimental::element_aligned);

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
        const Contacts& before = list_.before;
        std::array<std::size_t, lane_count> from;
        bool in_sequence = true;
        for (std::size_t lane = 0; lane < lane_count; ++lane) {
            while (before.pair[former_] < pair[lane]) ++former_;
            from[lane] = before.pair[former_] == pair[lane] ? former_ : before.count;
            in_sequence = in_sequence && from[lane] == from[0] + lane;
        }
        std::array<Lanes, history_count> history;
        for (std::size_t c = 0; c < history_count; ++c) {
            const double* values = before.history[c].data();
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
    std::size_t former_ = 0;  ///< contact of the last evaluation that may be the next to be found again
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
