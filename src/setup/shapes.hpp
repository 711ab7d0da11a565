#pragma once
#include <array>
#include <functional>
#include <variant>

namespace talus {

using Point = std::array<double, 3>;

/// Region of space that a body fills at the start. Axes beyond the dimension are ignored.
struct BoxShape {
    Point lower, upper;  ///< [m]
};
/// Ball in 3D, disc in 2D, interval in 1D; hollow if inner_radius > 0.
struct SphereShape {
    Point centre;                     ///< [m]
    double radius, inner_radius = 0;  ///< [m]
};
struct EllipsoidShape {
    Point centre, semi_axes;  ///< [m]
};
using BodyShape = std::variant<BoxShape, SphereShape, EllipsoidShape>;

bool contains(const BodyShape& shape, const Point& point, int dimension);
/// Volume [m3], area [m2] or length [m].
double volume(const BodyShape& shape, int dimension);
/// Corners of the smallest box around the shape.
BoxShape bounds(const BodyShape& shape, int dimension);
/// Middle of the shape, where lattices of round bodies are anchored.
Point centre(const BodyShape& shape);

enum class Lattice : unsigned char { cubic, close_packed };

/// Calls visit(point) for every lattice point inside the shape, in an order that depends on nothing else.
/// `spacing` is the D-th root of the volume per point [m]. cubic: square in 2D; close_packed: face-centred
/// cubic in 3D, hexagonal in 2D. In a box the lattice is fitted to a whole number of cells along each axis,
/// so that it continues through periodic boundaries; the volume per point is then that of the box divided by
/// the number of points.
void for_each_lattice_point(const BodyShape& shape, Lattice lattice, double spacing, int dimension,
                            const std::function<void(const Point&)>& visit);

}  // namespace talus
