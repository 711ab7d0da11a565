#pragma once
#include <algorithm>
#include <array>
#include <experimental/simd>
#include <stdexcept>

#include "physics/dem/contact_pass.hpp"

namespace talus::dem {

/// The pairs of [begin, end) whose gap is below `reach`, appended to those that touch.
inline void find_touching(const GrainRows& rows, double reach, std::size_t begin, std::size_t end,
                          ContactList& list) {
    std::array<std::uint32_t, lane_count> pair;
    GrainRows::Pointers a, b;
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
        list.touching_count += keep_negative(excess, pair.data(), list.touching.data() + list.touching_count);
    }
}

using Integers = std::experimental::rebind_simd_t<std::int64_t, Lanes>;
using Units = std::array<std::array<std::int64_t, lane_count>, 3>;

/// A vector in whole units; narrows `bearable` to the lanes that are within range.
inline Units in_units(const Vector3<Lanes>& vector, const Lanes& units_per_force, LaneMask& bearable) {
    Units units;
    std::size_t c = 0;
    for (const Lanes& component : {vector.x, vector.y, vector.z}) {
        const Lanes scaled = component * units_per_force;
        bearable = bearable && abs(scaled) < most_units;
        const Integers whole = std::experimental::static_simd_cast<Integers>(scaled);
        whole.copy_to(units[c++].data(), std::experimental::element_aligned);
    }
    return units;
}

/// The contacts of a list, as many at once as there are lanes.
template <class Table>
class PairLoop {
  public:
    static constexpr std::size_t history_count = Table::Law::history_count;
    static_assert(history_count <= most_history);

    PairLoop(const Evaluation& evaluation, const Table& table, ContactList& list)
        : evaluation_(evaluation),
          table_(table),
          list_(list),
          only_law_(in_all_lanes<typename Table::LawOfLanes>(table.pairs[0])) {}

    Overload operator()(std::size_t begin) {
        Overload overload;
        for (std::size_t k = begin; k < list_.touching_count; k += lane_count) {
            const std::size_t count = std::min(lane_count, list_.touching_count - k);
            const std::size_t wrong = contacts(list_.touching.data() + k, count);
            if (wrong < count && !overload.found) {
                const std::uint32_t p = list_.touching[k + wrong];
                overload = {true, list_.first[p], list_.second[p], false};
            }
        }
        return overload;
    }

  private:
    /// Returns the first lane with an overload, lane_count if there is none. Flat: vectors of lanes that are
    /// handed to functions go through memory.
    [[gnu::flatten]] std::size_t contacts(const std::uint32_t* touching, std::size_t count) {
        std::array<std::uint32_t, lane_count> pair;
        GrainRows::Pointers rows_a, rows_b;
        for (std::size_t lane = 0; lane < lane_count; ++lane) {
            pair[lane] = touching[std::min(lane, count - 1)];
            rows_a[lane] = evaluation_.rows[list_.first[pair[lane]]];
            rows_b[lane] = evaluation_.rows[list_.second[pair[lane]]];
        }
        const PlacedGrain<Lanes> a = placed_grain(rows_a), b = placed_grain(rows_b);
        const Vector3<Lanes> separation = a.position - b.position;
        const ContactKinematics<Lanes> k =
            grain_kinematics(separation, norm(separation), a.grain, b.grain, Lanes(evaluation_.time_step));

        const Lanes touched(
            [&](auto lane) { return list_.last_touch[pair[lane]] + 1 == evaluation_.now ? 1.0 : 0.0; });
        std::array<Lanes, history_count> history;
        for (std::size_t c = 0; c < history_count; ++c) {
            const Lanes stored([&](auto lane) { return list_.history[pair[lane] * history_count + c]; });
            history[c] = select(touched > 0, stored, Lanes(0.0));
        }
        const ContactLoad<Lanes> load =
            table_.pairs.materials() == 1 ? only_law_(k, history) : law_of(pair)(k, history);
        for (std::size_t lane = 0; lane < count; ++lane) {
            list_.last_touch[pair[lane]] = evaluation_.now;
            for (std::size_t c = 0; c < history_count; ++c)
                list_.history[pair[lane] * history_count + c] = history[c][lane];
        }

        LaneMask bearable = first_lanes(lane_count);
        const Lanes arm_a = contact_arm(a.grain.radius, k.overlap),
                    arm_b = contact_arm(b.grain.radius, k.overlap);
        const ContactLoad<Lanes> opposite{-load.force, -load.couple};
        add(list_.first, pair, count, in_units(load.force, a.units_per_force, bearable),
            in_units(torque_about_centre(k.normal, arm_a, load), a.units_per_force / a.grain.radius,
                     bearable));
        add(list_.second, pair, count, in_units(opposite.force, b.units_per_force, bearable),
            in_units(torque_about_centre(-k.normal, arm_b, opposite), b.units_per_force / b.grain.radius,
                     bearable));
        if (all_of(bearable)) return lane_count;
        return static_cast<std::size_t>(find_first_set(!bearable));
    }

    typename Table::LawOfLanes law_of(const std::array<std::uint32_t, lane_count>& pair) const {
        std::array<std::size_t, lane_count> index;
        for (std::size_t lane = 0; lane < lane_count; ++lane) index[lane] = list_.law[pair[lane]];
        return gather<typename Table::LawOfLanes>(table_.pairs, index);
    }

    void add(const std::vector<std::uint32_t>& side, const std::array<std::uint32_t, lane_count>& pair,
             std::size_t count, const Units& force, const Units& torque) {
        for (std::size_t lane = 0; lane < count; ++lane) {
            const std::uint32_t i = side[pair[lane]];
            if (i >= evaluation_.sums.size()) continue;  // a copy
            ForceSum& sum = evaluation_.sums[i];
            for (std::size_t c = 0; c < 3; ++c) {
                sum.force[c] += force[c][lane];
                sum.torque[c] += torque[c][lane];
            }
        }
    }

    const Evaluation& evaluation_;
    const Table& table_;
    ContactList& list_;
    typename Table::LawOfLanes only_law_;
};

template <class Elasticity, class SurfaceForce>
Overload evaluate_family(const Evaluation& evaluation, const AnyLawTable& laws, Pairs which,
                         ContactList& list) {
    const auto loop = [&]<class Table>(const Table& table) -> Overload {
        if constexpr (is_of_family<Elasticity, SurfaceForce, Table>) {
            const bool own = which == Pairs::own;
            if (own) list.touching_count = 0;
            const std::size_t begin = list.touching_count;
            find_touching(evaluation.rows, greatest_reach(laws, evaluation.largest_radius),
                          own ? 0 : list.own_count, own ? list.own_count : list.size(), list);
            return PairLoop(evaluation, table, list)(begin);
        } else {
            throw std::logic_error("a law of another family");
        }
    };
    return std::visit(loop, laws);
}

}  // namespace talus::dem
