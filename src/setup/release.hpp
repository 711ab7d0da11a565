#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "domain/particles.hpp"
#include "domain/terrain.hpp"
#include "physics/depth/settings.hpp"
#include "src/setup/shapes.hpp"

namespace talus {

/// A part of a depth-integrated flow at the start: a region in plan, and how deep it is.
struct Release {
    std::string name;
    BodyShape shape;
    double spacing = 0;             ///< wanted distance of particles in plan [m]
    double depth = 0;               ///< even, or in the middle of a parabolic one [m]
    bool parabolic = false;         ///< falls to zero at the edge of a ball or ellipsoid
    std::optional<double> level{};  ///< in place of a depth: elevation of a level surface [m]
    Point velocity{};               ///< in plan [m/s]
};

/// A column of a release, before it is a particle.
struct ReleasedColumn {
    Point place;              ///< in plan [m]
    double depth;             ///< as the model's form means it [m]
    double volume;            ///< [m3]
    double smoothing_length;  ///< [m]
    double correction;  ///< depth over the kernel sum of the columns that continue the release all around
};

/// The columns of a release, on a lattice of squares that fits its bounds, in order of y, then x. Those where
/// it is less than a thousandth of its greatest depth are left out. Places where the terrain is not known are
/// dry for a level, and given to `unknown` otherwise, the first one only.
std::vector<ReleasedColumn> columns_of(const Release& release, const Terrain& terrain,
                                       const depth::Settings& settings, int dimension,
                                       std::optional<Point>& unknown);

}  // namespace talus
