#include "physics/dem/size_levels.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "domain/grain_fields.hpp"
#include "domain/lanes.hpp"

namespace talus::dem {

Spheres spheres_of(const ParticleSet& grains) {
    return {
        {grains.data(field::position, 0), grains.data(field::position, 1), grains.data(field::position, 2)},
        grains.data(field::radius)};
}

std::span<const std::uint32_t> NearSpheres::operator()(const Spheres& spheres, std::span<const Run> runs,
                                                       const std::array<double, 3>& place, double reach) {
    std::size_t room = 0, count = 0;
    for (const Run& run : runs) room += run.end - run.begin + lane_count;
    if (near_.size() < room) near_.resize(room);
    for (const Run& run : runs)
        for (std::uint32_t k = run.begin; k < run.end; k += lane_count) {
            std::array<std::uint32_t, lane_count> at;
            for (std::uint32_t lane = 0; lane < lane_count; ++lane)
                at[lane] = std::min(k + lane, run.end - 1);
            const bool whole = k + lane_count <= run.end;
            const auto values = [&](const double* from) {
                return whole ? load(from + k) : Lanes([&](auto lane) { return from[at[lane]]; });
            };
            const Lanes limit = values(spheres.radius) + reach;
            Lanes excess = -(limit * limit);
            for (std::size_t a = 0; a < 3; ++a) {
                const Lanes r = values(spheres.x[a]) - place[a];
                excess += r * r;
            }
            if (!whole) excess = select(first_lanes(run.end - k), excess, Lanes(1.0));
            count += keep_negative(excess, at.data(), near_.data() + count);
        }
    return {near_.data(), count};
}

SizeLevels::SizeLevels(const ParticleSet& grains, double margin) : margin_(margin), own_(grains.size()) {
    const double* radius = grains.data(field::radius);
    const auto all = static_cast<std::uint32_t>(grains.size_with_halo());
    const double largest = all > 0 ? *std::max_element(radius, radius + all) : 0;
    std::map<int, std::vector<std::uint32_t>> members;
    for (std::uint32_t i = 0; i < all; ++i) members[std::ilogb(largest / radius[i])].push_back(i);
    for (auto& [level, indices] : members)
        levels_.push_back(sorted_level(grains, std::move(indices), margin));
}

bool SizeLevels::one_is_enough(const ParticleSet& grains, double largest) {
    const double* radius = grains.data(field::radius);
    return std::all_of(radius, radius + grains.size_with_halo(),
                       [half = 0.5 * largest](double r) { return r > half; });
}

SizeLevels::Level SizeLevels::sorted_level(const ParticleSet& grains, std::vector<std::uint32_t> members,
                                           double margin) {
    const double* radius = grains.data(field::radius);
    double largest = 0;
    for (const std::uint32_t i : members) largest = std::max(largest, radius[i]);
    Level level{CellGrid(Box{}, 2 * largest + margin, 1), largest, {}, {}, std::move(members), {}};
    const auto key = [&](std::uint32_t i) {
        Cell cell;
        for (int axis = 0; axis < 3; ++axis)
            cell[static_cast<std::size_t>(axis)] =
                level.grid.index_along(axis, grains.data(field::position, axis)[i]);
        return key_of(cell);
    };
    struct Placed {
        CellKey key;
        std::uint32_t grain;
    };
    std::vector<Placed> placed;
    placed.reserve(level.grain.size());
    for (const std::uint32_t i : level.grain) placed.push_back({key(i), i});
    std::sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
        return a.key != b.key ? a.key < b.key : a.grain < b.grain;
    });
    for (std::uint32_t k = 0; k < placed.size(); ++k) {
        if (k == 0 || placed[k].key != placed[k - 1].key)
            level.cells.push_back({placed[k].key, k, k, false, false});
        level.cells.back().end = k + 1;
        level.grain[k] = placed[k].grain;
    }
    const auto in_order = [&](const double* from) {
        std::vector<double> values;
        values.reserve(level.grain.size());
        for (const std::uint32_t i : level.grain) values.push_back(from[i]);
        return values;
    };
    for (int axis = 0; axis < 3; ++axis)
        level.x[static_cast<std::size_t>(axis)] = in_order(grains.data(field::position, axis));
    level.radius = in_order(radius);
    return level;
}

/// The cells of a level in which partners of a cell's grains may be.
SizeLevels::Range SizeLevels::reached(const Level& from, const CellEntry& cell, const Level& into) const {
    const auto grains = static_cast<std::ptrdiff_t>(cell.begin), end = static_cast<std::ptrdiff_t>(cell.end);
    const double reach = *std::max_element(from.radius.begin() + grains, from.radius.begin() + end) +
                         into.largest_radius + margin_;
    Range range;
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const auto [least, most] = std::minmax_element(from.x[a].begin() + grains, from.x[a].begin() + end);
        range.lowest[a] = into.grid.index_along(axis, *least - reach);
        range.highest[a] = into.grid.index_along(axis, *most + reach);
    }
    return range;
}

void SizeLevels::find_runs(const Level& level, const Range& range, std::vector<std::size_t>& hints,
                           std::vector<Run>& runs) {
    const std::vector<CellEntry>& cells = level.cells;
    const auto before = [](const CellEntry& cell, CellKey key) { return cell.key < key; };
    const auto first_from = [&](CellKey key, std::size_t hint) {
        constexpr std::size_t few = 8;
        if (hint > 0 && cells[hint - 1].key >= key) hint = 0;  // ranges went back
        const std::size_t near = std::min(hint + few, cells.size());
        for (; hint < near; ++hint)
            if (cells[hint].key >= key) return hint;
        const auto at =
            std::lower_bound(cells.begin() + static_cast<std::ptrdiff_t>(near), cells.end(), key, before);
        return static_cast<std::size_t>(at - cells.begin());
    };
    runs.clear();
    std::size_t row = 0;
    for (int z = range.lowest[2]; z <= range.highest[2]; ++z)
        for (int y = range.lowest[1]; y <= range.highest[1]; ++y, ++row) {
            if (row == hints.size()) hints.push_back(0);
            hints[row] = first_from(key_of({range.lowest[0], y, z}), hints[row]);
            const CellKey last = key_of({range.highest[0], y, z});
            for (std::size_t c = hints[row]; c < cells.size() && cells[c].key <= last; ++c) {
                if (!runs.empty() && runs.back().end == cells[c].begin)
                    runs.back().end = cells[c].end;
                else
                    runs.push_back({cells[c].begin, cells[c].end});
            }
        }
}

}  // namespace talus::dem
