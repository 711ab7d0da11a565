#include "src/analysis/binding.hpp"

#include <algorithm>
#include <numeric>

#include "comm/exact_sum.hpp"

namespace talus {

namespace {

struct PointMass {
    double mass = 0;
    Point centre{}, velocity{};
};

/// The search for one remnant after the other among the units of all ranks.
class BindingSearch {
  public:
    BindingSearch(const Communicator& comm, std::span<const BindingUnit> units, const BindingRules& rules)
        : comm_(comm), units_(units), rules_(rules), set_of_(units.size(), none) {}

    /// False if nothing of the group holds together.
    bool gather_around(const Fragment& seed) {
        const std::size_t here = sets_.size();
        std::uint64_t seed_units = 0;
        for (std::size_t u = 0; u < units_.size(); ++u)
            if (set_of_[u] == none && units_[u].group == seed.label) {
                set_of_[u] = here;
                ++seed_units;
            }
        const bool whole = comm_.all_sum(seed_units) == 1;
        BoundSet set{seed.label, 0, 0, 0, 1};
        PointMass all = total(here);
        while (set.unsettled > 0 && set.rounds < rules_.most_rounds && all.mass > 0) {
            set.unsettled = comm_.all_sum(join_and_leave(here, all, whole ? &seed : nullptr));
            ++set.rounds;
            all = total(here);
        }
        set.mass = all.mass;
        if (!(all.mass > 0)) return false;
        set.pieces = note_groups(here);
        sets_.push_back(set);
        return true;
    }
    /// Whether part of a group is bound already.
    bool holds_part_of(std::uint64_t group) const {
        return std::binary_search(bound_groups_.begin(), bound_groups_.end(), group);
    }

    Binding result() const {
        std::vector<std::size_t> order(sets_.size()), place(sets_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t a, std::size_t b) { return sets_[a].mass > sets_[b].mass; });
        Binding binding;
        for (const std::size_t set : order) {
            place[set] = binding.sets.size();
            binding.sets.push_back(sets_[set]);
        }
        for (const std::size_t set : set_of_)
            binding.set_of.push_back(set == none ? sets_.size() : place[set]);
        return binding;
    }

  private:
    static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

    PointMass total(std::size_t set) const {
        std::vector<ExactSum> sums(7);
        for (std::size_t u = 0; u < units_.size(); ++u) {
            if (set_of_[u] != set) continue;
            const BindingUnit& unit = units_[u];
            sums[0].add(unit.mass);
            for (std::size_t a = 0; a < 3; ++a) {
                sums[1 + a].add(unit.mass * unit.centre[a]);
                sums[4 + a].add(unit.mass * unit.velocity[a]);
            }
        }
        ExactSum::all_reduce(comm_, sums);
        PointMass all{sums[0].value(), {}, {}};
        for (std::size_t a = 0; a < 3 && all.mass > 0; ++a) {
            all.centre[a] = sums[1 + a].value() / all.mass;
            all.velocity[a] = sums[4 + a].value() / all.mass;
        }
        return all;
    }

    bool is_bound(const BindingUnit& unit, const PointMass& all, bool member) const {
        const double rest = member ? all.mass - unit.mass : all.mass;
        if (!(rest > 0)) return true;  // nothing else to be bound to
        // From the rest's centre of mass, not from that of all, if the unit is a member.
        const double stretch = member ? all.mass / rest : 1;
        const Point velocity = times(stretch, minus(unit.velocity, all.velocity));
        const double distance = stretch * norm(minus(unit.centre, all.centre));
        return dot(velocity, velocity) * distance < 2 * rules_.constant * (rest + unit.mass);
    }

    std::uint64_t join_and_leave(std::size_t set, const PointMass& all, const Fragment* stays) {
        std::uint64_t changed = 0;
        for (std::size_t u = 0; u < units_.size(); ++u) {
            const bool member = set_of_[u] == set;
            if (!member && set_of_[u] != none) continue;
            if (stays && units_[u].group == stays->label) continue;
            const bool bound = is_bound(units_[u], all, member);
            changed += bound != member;
            set_of_[u] = bound ? set : none;
        }
        return changed;
    }

    /// Returns how many groups have a part in the set.
    std::uint64_t note_groups(std::size_t set) {
        const auto sort = [](std::vector<std::uint64_t>& labels) {
            std::sort(labels.begin(), labels.end());
            labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
        };
        std::vector<std::uint64_t> groups;
        for (std::size_t u = 0; u < units_.size(); ++u)
            if (set_of_[u] == set) groups.push_back(units_[u].group);
        sort(groups);
        groups = comm_.all_gather(std::span<const std::uint64_t>(groups));
        sort(groups);
        bound_groups_.insert(bound_groups_.end(), groups.begin(), groups.end());
        sort(bound_groups_);
        return groups.size();
    }

    const Communicator& comm_;
    std::span<const BindingUnit> units_;
    BindingRules rules_;
    std::vector<std::size_t> set_of_;
    std::vector<BoundSet> sets_;
    std::vector<std::uint64_t> bound_groups_;  ///< labels, sorted, the same on every rank
};

}  // namespace

Binding find_bound(const Communicator& comm, std::span<const BindingUnit> units,
                   std::span<const Fragment> groups, const BindingRules& rules) {
    BindingSearch search(comm, units, rules);
    std::size_t found = 0;
    for (const Fragment& seed : groups) {
        if (found == rules.count) break;
        if (search.holds_part_of(seed.label)) continue;
        if (!search.gather_around(seed)) break;
        ++found;
    }
    return search.result();
}

}  // namespace talus
