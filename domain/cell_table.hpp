#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "domain/cell_grid.hpp"

namespace talus {

/// The particles of one cell, contiguous in their set: own cells before the set's size(), copies after.
struct CellEntry {
    CellKey key;
    std::uint32_t begin, end;
    bool is_copy;
    bool touches_copies;  ///< own cell with a copied cell within reach
};

/// A range of particles that lie one after the other in memory.
struct Run {
    std::uint32_t begin, end;
};

/// Which own cells a loop visits: those that need no halo can be worked on while it is on its way.
enum class Cells : std::uint8_t { all, interior, boundary };

/// The cells that hold a rank's own particles and copies, in the order of their keys. Every loop over
/// partners visits cells in that order and particles in order of id within a cell, on any number of ranks.
class CellTable {
  public:
    /// `entries` in any order; marks the own cells that touch copies.
    void build(std::vector<CellEntry> entries, int dimension, int reach);

    std::span<const CellEntry> cells() const { return cells_; }

    /// Calls visit(cell, runs) for the selected own cells in order; `runs` covers the particles of all
    /// cells within reach, the cell's own included, in canonical order.
    template <class Visit>
    void for_each_own(Cells which, Visit&& visit) const {
        Cursors cursors = start();
        for (std::size_t c = 0; c < cells_.size(); ++c) {
            const CellEntry& cell = cells_[c];
            if (cell.is_copy) continue;
            if (which == Cells::interior && cell.touches_copies) continue;
            if (which == Cells::boundary && !cell.touches_copies) continue;
            visit(cell, collect(cursors, cell.key));
        }
    }

  private:
    struct Cursors {
        std::vector<std::uint32_t> first;  ///< one a row of cells: first entry that can still be reached
        std::vector<Run> runs;
    };
    Cursors start() const;
    std::span<const Run> collect(Cursors& cursors, CellKey key) const;

    std::vector<CellEntry> cells_;
    std::vector<std::int64_t> row_offsets_;  ///< key of (dy, dz) relative to a cell, in order
    int reach_ = 1;
};

}  // namespace talus
