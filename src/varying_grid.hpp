#pragma once
#include <memory>

#include "domain/cell_grid.hpp"

namespace talus {

/// Cells one interaction radius wide, or a part of it, where that may change from step to step.
class VaryingGrid {
  public:
    explicit VaryingGrid(int cells_per_radius = 1) : cells_per_radius_(cells_per_radius) {}

    /// Fits the grid to the radius that is needed now [m], the same on every rank; `varies`: with room to
    /// grow in the step, once cells and halo are made. True if the grid is a new one.
    bool fit(const Box& box, double needed, bool varies);

    bool exists() const { return grid_ != nullptr; }
    const CellGrid& operator*() const { return *grid_; }
    const CellGrid* operator->() const { return grid_.get(); }

  private:
    std::unique_ptr<CellGrid> grid_;
    int cells_per_radius_;
    double radius_ = 0;
};

}  // namespace talus
