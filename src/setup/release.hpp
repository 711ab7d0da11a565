#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "domain/box.hpp"
#include "domain/polygon.hpp"
#include "domain/terrain.hpp"
#include "physics/depth/settings.hpp"
#include "src/setup/shapes.hpp"

namespace talus {

/// A part of a depth-integrated flow at the start: a region in plan, and how deep it is.
struct Release {
    std::string name;
    BodyShape shape;
    Polygon area;  ///< in place of a shape, if it has rings
    std::shared_ptr<const TerrainGrid>
        depth_raster{};             ///< in place of a depth: of the nearest cell, NaN is dry
    double spacing = 0;             ///< wanted distance of particles in plan [m]
    double depth = 0;               ///< even, or in the middle of a parabolic one [m]
    bool parabolic = false;         ///< falls to zero at the edge of a ball or ellipsoid
    std::optional<double> level{};  ///< in place of a depth: elevation of a level surface [m]
    Point velocity{};               ///< in plan [m/s]
    double solid_fraction = 1;      ///< of the volume, the rest is water: flows of two phases only
};

/// A column of a release, before it is a particle.
struct ReleasedColumn {
    Point place;              ///< in plan [m]
    double depth;             ///< as the model's form means it [m]
    double volume;            ///< [m3]
    double smoothing_length;  ///< [m]
};

struct ReleasedColumns {
    std::vector<ReleasedColumn> released;
    std::vector<ReleasedColumn>
        beyond;  ///< where a level goes on around the region, for a moment, if it is balanced
    std::optional<Point> unknown;  ///< the first place where a release would be but the terrain is not known
    std::optional<Point> cut;      ///< the first wet place of a level beside which the terrain is not known
    std::optional<Point> outside_box;  ///< the first beyond a closed side of the box
};

/// The columns of a release, on a lattice of squares that fits its bounds, in order of y, then x. Those where
/// it is less than a thousandth of its greatest depth are left out. Where the terrain is not known, levels
/// are dry.
ReleasedColumns columns_of(const Release& release, const Terrain& terrain, const depth::Settings& settings,
                           const Box& box);

}  // namespace talus
