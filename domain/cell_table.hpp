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
    /// `entries` in any order; marks the own cells that touch copies and lists what each can reach.
    void build(std::vector<CellEntry> entries, int dimension, int reach);

    std::span<const CellEntry> cells() const { return cells_; }

    /// Calls visit(cell, runs, k) for the selected own cells in order, k counting all own cells; `runs`
    /// covers the particles of all cells within reach, the cell's own included, in canonical order.
    template <class Visit>
    void for_each_own(Cells which, Visit&& visit) const {
        for (std::size_t k = 0; k < own_.size(); ++k) {
            const CellEntry& cell = cells_[own_[k].place];
            if (which == Cells::interior && cell.touches_copies) continue;
            if (which == Cells::boundary && !cell.touches_copies) continue;
            visit(cell,
                  std::span<const Run>(runs_.data() + own_[k].first_run, runs_.data() + own_[k].end_run), k);
        }
    }

    /// The particles of all cells within `reach` of a cell, which need not be in the table, in canonical
    /// order.
    void list_runs(const Cell& centre, int dimension, int reach, std::vector<Run>& runs) const;

  private:
    struct OwnCell {
        std::uint32_t place;               ///< in cells_
        std::uint32_t first_run, end_run;  ///< in runs_
    };

    std::vector<CellEntry> cells_;
    std::vector<OwnCell> own_;
    std::vector<Run> runs_;
};

}  // namespace talus
