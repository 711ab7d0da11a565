#pragma once
#include <memory>
#include <variant>

#include "src/setup/surface_mesh.hpp"

namespace talus {

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
    Rotation orientation;     ///< from the axes of the ellipsoid to those of space
};
/// Inside of a surface of triangles, in 3D.
struct MeshShape {
    Point centre;                                ///< where the surface's origin lies [m]
    std::shared_ptr<const SurfaceMesh> surface;  ///< its origin is its centroid
};
using BodyShape = std::variant<BoxShape, SphereShape, EllipsoidShape, MeshShape>;

bool contains(const BodyShape& shape, const Point& point, int dimension);
/// Volume [m3], area [m2] or length [m].
double volume(const BodyShape& shape, int dimension);
/// Corners of the smallest box around the shape.
BoxShape bounds(const BodyShape& shape, int dimension);
/// Least extent along any axis [m].
double thickness(const BodyShape& shape, int dimension);
/// Middle of the shape, where lattices of round bodies are anchored.
Point centre(const BodyShape& shape);
/// The shape, moved.
BodyShape moved(const BodyShape& shape, const Point& by);

}  // namespace talus
