#include "physics/dem/contact_list.hpp"

#include <array>

#include "domain/grain_fields.hpp"
#include "domain/lanes.hpp"
#include "physics/dem/size_levels.hpp"

namespace talus::dem {

void ContactList::clear() {
    first.clear();
    second.clear();
    law.clear();
    touching_count = own_count = 0;
}

void ContactList::finish() {
    last_touch.assign(size(), 0);
    history.resize(size() * history_count);
    touching.resize(size() + lane_count);
    touching_count = 0;
}

namespace {

/// Puts pairs into a list, those with copies after those of own grains.
class ListedPairs {
  public:
    ListedPairs(const ParticleSet& grains, const PairRule& rule, ContactList& list)
        : body_(grains.data(field::body)),
          id_(grains.data(field::copied_id)),
          own_(grains.size()),
          rule_(rule),
          list_(list) {
        list_.clear();
    }

    /// `both_ways`: pairs of own grains come from either side.
    void add(std::uint32_t i, std::uint32_t j, bool both_ways) {
        if (i == j || (rule_.held[body_[i]] && rule_.held[body_[j]]) || (i >= own_ && j >= own_)) return;
        const bool in_order = id_[i] < id_[j];
        const Pair pair = in_order ? Pair{i, j} : Pair{j, i};
        if (i >= own_ || j >= own_)
            with_copies_.push_back(pair);
        else if (in_order || !both_ways)
            add_to_list(pair);
    }

    void finish() {
        list_.own_count = list_.size();
        for (const Pair& pair : with_copies_) add_to_list(pair);
        list_.finish();
    }

  private:
    struct Pair {
        std::uint32_t first, second;
    };
    void add_to_list(const Pair& pair) {
        list_.add(pair.first, pair.second,
                  rule_.material[body_[pair.first]] * rule_.materials + rule_.material[body_[pair.second]]);
    }

    const std::uint8_t* body_;
    const std::uint64_t* id_;
    std::size_t own_;
    const PairRule& rule_;
    ContactList& list_;
    std::vector<Pair> with_copies_;
};

}  // namespace

void list_pairs(const ParticleSet& grains, const CellTable& table, const PairRule& rule, ContactList& list) {
    ListedPairs pairs(grains, rule, list);
    if (!SizeLevels::one_is_enough(grains, rule.largest_radius)) {
        SizeLevels(grains, rule.margin).for_each_pair([&](std::uint32_t i, std::uint32_t j, bool one_level) {
            pairs.add(i, j, one_level);
        });
        return pairs.finish();
    }
    const Spheres spheres{
        {grains.data(field::position, 0), grains.data(field::position, 1), grains.data(field::position, 2)},
        grains.data(field::radius)};
    NearSpheres near;
    table.for_each_own(Cells::all, [&](const CellEntry& cell, std::span<const Run> runs, std::size_t) {
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            const std::array<double, 3> place{spheres.x[0][i], spheres.x[1][i], spheres.x[2][i]};
            for (const std::uint32_t j : near(spheres, runs, place, spheres.radius[i] + rule.margin))
                pairs.add(i, j, true);
        }
    });
    pairs.finish();
}

}  // namespace talus::dem
