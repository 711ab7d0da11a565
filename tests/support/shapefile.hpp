#pragma once
#include <filesystem>
#include <string>

#include "domain/polygon.hpp"

namespace talus::testing {

/// Writes a polygon's rings (given anticlockwise) as a shapefile, .shp, .shx and .dbf, with a numeric
/// attribute `d0` and, if it is not empty, `reference` as .prj. ESRI Shapefile Technical Description (1998).
/// For one rank.
void write_shapefile(const std::filesystem::path& file, const Polygon& polygon, double d0,
                     const std::string& reference);

}  // namespace talus::testing
