#pragma once
#include <string>
#include <string_view>

#include "domain/terrain.hpp"

namespace talus {

/// The grid in the text of an ESRI ASCII raster: cellsize, or dx and dy; xllcorner or xllcenter, and for y
/// alike; NODATA_value if cells are unknown. Throws std::runtime_error "line L: what" for anything that is
/// not a number, a header that is not complete, and too few or too many values.
TerrainGrid parse_ascii_grid(std::string_view text);

/// The text of such a raster, values in single precision, -9999 where unknown.
std::string ascii_grid(const TerrainGrid& grid);

}  // namespace talus
