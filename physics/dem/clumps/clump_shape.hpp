#pragma once
#include <span>
#include <vector>

#include "physics/dem/vector3.hpp"

namespace talus::dem {

/// Spheres that overlap or touch and move as one rigid body, evenly filled: what two of them share counts
/// once.
struct ClumpShape {
    std::vector<Vector3<>> centres;  ///< of the spheres from the centre of mass, along the principal axes [m]
    std::vector<double> radii;       ///< [m]
    double volume;                   ///< of the union [m3]
    Vector3<> inertia;               ///< principal moments of the union at density 1 [m5]
    double bounding_radius;          ///< about the centre of mass [m]
    double extent;                   ///< greatest distance of two spheres' centres [m]
    /// Of the mass at each sphere's centre, for gravity: they add up to 1 with the clump's centre of mass,
    /// and differ from those of the spheres' volumes as little as that takes (least squares, relative) [1].
    std::vector<double> mass_shares;
};

/// Volume, centre and moments are exact for spheres that do not overlap; else the union is integrated along
/// lines, exactly in one direction and by the midpoint rule with `lines` a side across it. Throws
/// std::invalid_argument if there are no spheres or a radius is not above 0.
ClumpShape clump_shape(std::span<const Vector3<>> centres, std::span<const double> radii, int lines = 512);

}  // namespace talus::dem
