#include "physics/gravity/tree_key.hpp"

#include <algorithm>

#include "domain/partition.hpp"

namespace talus::gravity {

std::uint64_t morton_of(const Cell& cell) { return block_key_of(cell, 0); }
Cell cell_of_morton(std::uint64_t key) { return block_of(key); }

std::uint64_t morton_within(const CellGrid& grid, const Cell& cell, const std::array<double, 3>& position) {
    constexpr int places = 1 << cell_level;
    Cell place{};
    for (std::size_t a = 0; a < 3; ++a) {
        const double within = grid.in_cells(static_cast<int>(a), position[a]) - cell[a];
        place[a] = static_cast<int>(std::clamp(within * places, 0.0, places - 1.0)) - places / 2;
    }
    return block_key_of(place, 0);
}

}  // namespace talus::gravity
