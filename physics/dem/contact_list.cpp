#include "physics/dem/contact_list.hpp"

#include <algorithm>
#include <array>

#include "domain/grain_fields.hpp"
#include "domain/lanes.hpp"

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

void list_pairs(const ParticleSet& grains, const CellTable& table, const PairRule& rule, ContactList& list) {
    const std::array<const double*, 3> x{grains.data(field::position, 0), grains.data(field::position, 1),
                                         grains.data(field::position, 2)};
    const double* radius = grains.data(field::radius);
    const std::uint8_t* body = grains.data(field::body);
    const std::uint64_t* id = grains.data(field::copied_id);
    const auto own = static_cast<std::uint32_t>(grains.size());
    struct Pair {
        std::uint32_t first, second;
    };
    std::vector<Pair> with_copies;
    std::vector<std::uint32_t> near;
    list.clear();
    const auto add = [&](std::uint32_t first, std::uint32_t second) {
        list.add(first, second, rule.material[body[first]] * rule.materials + rule.material[body[second]]);
    };
    table.for_each_own(Cells::all, [&](const CellEntry& cell, std::span<const Run> runs, std::size_t) {
        std::size_t room = 0;
        for (const Run& run : runs) room += run.end - run.begin + lane_count;
        near.resize(std::max(near.size(), room));
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            std::size_t count = 0;
            for (const Run& run : runs)
                for (std::uint32_t k = run.begin; k < run.end; k += lane_count) {
                    std::array<std::uint32_t, lane_count> place;
                    for (std::uint32_t lane = 0; lane < lane_count; ++lane)
                        place[lane] = std::min(k + lane, run.end - 1);
                    const bool whole = k + lane_count <= run.end;
                    const auto values = [&](const double* from) {
                        return whole ? load(from + k) : Lanes([&](auto lane) { return from[place[lane]]; });
                    };
                    const Lanes limit = values(radius) + (radius[i] + rule.margin);
                    Lanes excess = -(limit * limit);
                    for (const double* along : x) {
                        const Lanes r = values(along) - along[i];
                        excess += r * r;
                    }
                    if (!whole) excess = select(first_lanes(run.end - k), excess, Lanes(1.0));
                    count += keep_negative(excess, place.data(), near.data() + count);
                }
            for (std::size_t k = 0; k < count; ++k) {
                const std::uint32_t j = near[k];
                if (j == i || (rule.held[body[i]] && rule.held[body[j]])) continue;
                if (j >= own)
                    with_copies.push_back(id[i] < id[j] ? Pair{i, j} : Pair{j, i});
                else if (id[i] < id[j])
                    add(i, j);
            }
        }
    });
    list.own_count = list.size();
    for (const Pair& pair : with_copies) add(pair.first, pair.second);
    list.finish();
}

}  // namespace talus::dem
