#pragma once
#include <bit>
#include <compare>
#include <cstdint>

#include "domain/cell_grid.hpp"

namespace talus::gravity {

/// Place of a particle in the octree: Morton key of its cell of the global grid, then of its place within the
/// cell. Each octal digit, most significant first, chooses a child; a node is what agrees in its first
/// digits.
struct TreeKey {
    std::uint64_t cell, within;
    auto operator<=>(const TreeKey&) const = default;
};

inline constexpr int cell_level = 21;  ///< digits down to a cell
inline constexpr int last_level = 42;  ///< digits in all

/// How many leading digits two keys share.
constexpr int common_level(const TreeKey& a, const TreeKey& b) {
    const bool same_cell = a.cell == b.cell;
    const std::uint64_t differing = same_cell ? a.within ^ b.within : a.cell ^ b.cell;
    const int digits = (std::countl_zero(differing) - 1) / 3;  // 63 bits are in use
    return same_cell ? cell_level + digits : digits;
}

/// The digit that chooses a child of a node of that level.
constexpr unsigned digit(const TreeKey& key, int level) {
    const int place = 3 * (cell_level - 1 - level % cell_level);
    return static_cast<unsigned>((level < cell_level ? key.cell : key.within) >> place & 7);
}

/// Lowest and highest key of a cell in the node of `level` that holds `key`; level <= cell_level.
struct CellRange {
    std::uint64_t first, last;
};
constexpr CellRange cells_of(const TreeKey& key, int level) {
    const std::uint64_t below = (std::uint64_t{1} << 3 * (cell_level - level)) - 1;
    return {key.cell & ~below, key.cell | below};
}

/// Morton key of a cell.
std::uint64_t morton_of(const Cell& cell);
Cell cell_of_morton(std::uint64_t key);
/// Morton key of a position within its cell; those beyond the outermost cells are counted to their edge.
std::uint64_t morton_within(const CellGrid& grid, const Cell& cell, const std::array<double, 3>& position);

}  // namespace talus::gravity
