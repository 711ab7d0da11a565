#include "domain/cell_table.hpp"

#include <algorithm>

namespace talus {

void CellTable::build(std::vector<CellEntry> entries, int dimension, int reach) {
    cells_ = std::move(entries);
    std::sort(cells_.begin(), cells_.end(),
              [](const CellEntry& a, const CellEntry& b) { return a.key < b.key; });
    // Of the cells before each: those whose particles do not follow the last cell's in memory, and copies.
    std::vector<std::uint32_t> breaks(cells_.size() + 1, 0), copies(cells_.size() + 1, 0);
    for (std::size_t k = 0; k < cells_.size(); ++k) {
        breaks[k + 1] = breaks[k] + (k == 0 || cells_[k].begin != cells_[k - 1].end ? 1 : 0);
        copies[k + 1] = copies[k] + (cells_[k].is_copy ? 1 : 0);
    }
    struct Row {
        std::int64_t offset;               // of its keys from a cell's
        std::uint32_t first = 0, end = 0;  // entries that the last cell reached
    };
    std::vector<Row> rows;
    const int reach_y = dimension > 1 ? reach : 0, reach_z = dimension > 2 ? reach : 0;
    for (int dz = -reach_z; dz <= reach_z; ++dz)
        for (int dy = -reach_y; dy <= reach_y; ++dy)
            rows.push_back({static_cast<std::int64_t>(dz) * (std::int64_t{1} << 42) +
                            static_cast<std::int64_t>(dy) * (std::int64_t{1} << 21)});

    own_.clear();
    runs_.clear();
    const auto append = [this](std::size_t first_run, std::uint32_t begin, std::uint32_t end) {
        if (runs_.size() > first_run && runs_.back().end == begin)
            runs_.back().end = end;
        else
            runs_.push_back({begin, end});
    };
    for (std::size_t place = 0; place < cells_.size(); ++place) {
        CellEntry& cell = cells_[place];
        cell.touches_copies = false;
        if (cell.is_copy) continue;
        const std::size_t first_run = runs_.size();
        for (Row& row : rows) {
            const CellKey centre = cell.key + static_cast<CellKey>(row.offset);
            const CellKey lowest = centre - static_cast<CellKey>(reach),
                          highest = centre + static_cast<CellKey>(reach);
            while (row.first < cells_.size() && cells_[row.first].key < lowest) ++row.first;
            row.end = std::max(row.end, row.first);
            while (row.end < cells_.size() && cells_[row.end].key <= highest) ++row.end;
            if (row.first == row.end) continue;
            if (copies[row.first] != copies[row.end]) cell.touches_copies = true;
            if (breaks[row.first + 1] == breaks[row.end])
                append(first_run, cells_[row.first].begin, cells_[row.end - 1].end);
            else
                for (std::uint32_t k = row.first; k < row.end; ++k)
                    append(first_run, cells_[k].begin, cells_[k].end);
        }
        own_.push_back({static_cast<std::uint32_t>(place), static_cast<std::uint32_t>(first_run),
                        static_cast<std::uint32_t>(runs_.size())});
    }
}

void CellTable::list_runs(const Cell& centre, int dimension, int reach, std::vector<Run>& runs) const {
    runs.clear();
    const int reach_y = dimension > 1 ? reach : 0, reach_z = dimension > 2 ? reach : 0;
    auto next = cells_.begin();
    for (int z = centre[2] - reach_z; z <= centre[2] + reach_z; ++z)
        for (int y = centre[1] - reach_y; y <= centre[1] + reach_y; ++y) {
            const CellKey lowest = key_of({centre[0] - reach, y, z}),
                          highest = key_of({centre[0] + reach, y, z});
            next = std::lower_bound(next, cells_.end(), lowest,
                                    [](const CellEntry& cell, CellKey key) { return cell.key < key; });
            for (; next != cells_.end() && next->key <= highest; ++next) {
                if (!runs.empty() && runs.back().end == next->begin)
                    runs.back().end = next->end;
                else
                    runs.push_back({next->begin, next->end});
            }
        }
}

}  // namespace talus
