#pragma once
#include <functional>
#include <vector>

#include "src/setup/shapes.hpp"

namespace talus {

enum class Lattice : unsigned char { cubic, close_packed };

/// Points of one rectangular cell that is repeated to fill space.
struct UnitCell {
    Point edges;                ///< in spacings: a cell of unit spacing has unit volume per point [1]
    std::vector<Point> points;  ///< in units of the edges [1]
    bool fits_boxes = true;     ///< small enough to be fitted to the edges of a box
};

/// cubic: square in 2D; close_packed: face-centred cubic in 3D, hexagonal in 2D.
UnitCell lattice_cell(Lattice lattice, int dimension);

/// Calls visit(point) for every point of the packing inside the shape, in an order that depends on nothing
/// else. `spacing` is the D-th root of the volume per point [m]. In a box a lattice is fitted to a whole
/// number of cells along each axis, so that it continues through periodic boundaries; the volume per point is
/// then that of the box divided by the number of points. In other shapes the packing is anchored at the
/// shape's centre and cut at its surface; which points are inside does not depend on where the shape is.
void for_each_point(const BodyShape& shape, const UnitCell& cell, double spacing, int dimension,
                    const std::function<void(const Point&)>& visit);

}  // namespace talus
