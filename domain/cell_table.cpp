#include "domain/cell_table.hpp"

#include <algorithm>

namespace talus {

void CellTable::build(std::vector<CellEntry> entries, int dimension, int reach) {
    cells_ = std::move(entries);
    reach_ = reach;
    std::sort(cells_.begin(), cells_.end(),
              [](const CellEntry& a, const CellEntry& b) { return a.key < b.key; });
    row_offsets_.clear();
    const int reach_y = dimension > 1 ? reach : 0, reach_z = dimension > 2 ? reach : 0;
    for (int dz = -reach_z; dz <= reach_z; ++dz)
        for (int dy = -reach_y; dy <= reach_y; ++dy)
            row_offsets_.push_back(static_cast<std::int64_t>(dz) * (std::int64_t{1} << 42) +
                                   static_cast<std::int64_t>(dy) * (std::int64_t{1} << 21));

    Cursors cursors = start();
    const auto first_copy_end = [this](std::uint32_t k, CellKey last) {
        for (; k < cells_.size() && cells_[k].key <= last; ++k)
            if (cells_[k].is_copy) return true;
        return false;
    };
    for (CellEntry& cell : cells_) {
        cell.touches_copies = false;
        if (cell.is_copy) continue;
        for (std::size_t row = 0; row < row_offsets_.size(); ++row) {
            const CellKey centre = cell.key + static_cast<CellKey>(row_offsets_[row]);
            const CellKey lowest = centre - static_cast<CellKey>(reach_);
            std::uint32_t& k = cursors.first[row];
            while (k < cells_.size() && cells_[k].key < lowest) ++k;
            if (first_copy_end(k, centre + static_cast<CellKey>(reach_))) cell.touches_copies = true;
        }
    }
}

CellTable::Cursors CellTable::start() const {
    return {std::vector<std::uint32_t>(row_offsets_.size(), 0), {}};
}

std::span<const Run> CellTable::collect(Cursors& cursors, CellKey key) const {
    cursors.runs.clear();
    for (std::size_t row = 0; row < row_offsets_.size(); ++row) {
        const CellKey centre = key + static_cast<CellKey>(row_offsets_[row]);
        const CellKey lowest = centre - static_cast<CellKey>(reach_),
                      highest = centre + static_cast<CellKey>(reach_);
        std::uint32_t& first = cursors.first[row];
        while (first < cells_.size() && cells_[first].key < lowest) ++first;
        for (std::uint32_t k = first; k < cells_.size() && cells_[k].key <= highest; ++k) {
            if (!cursors.runs.empty() && cursors.runs.back().end == cells_[k].begin)
                cursors.runs.back().end = cells_[k].end;
            else
                cursors.runs.push_back({cells_[k].begin, cells_[k].end});
        }
    }
    return cursors.runs;
}

}  // namespace talus
