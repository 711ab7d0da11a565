#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "comm/communicator.hpp"
#include "domain/polygon.hpp"
#include "domain/terrain.hpp"

/// Rasters and areas of maps: ESRI ASCII grids, GeoTIFF, shapefiles. Only the root opens files; GDAL is
/// loaded when the first file needs it (io/geodata). Failures are AgreedErrors on every rank, "file: what is
/// wrong", with line or cell; cells are counted from 1, rows from the north.
namespace talus {

/// Values at the centres of a raster's cells, NaN where nothing is known.
struct Raster {
    TerrainGrid grid;
    std::string reference;  ///< of the coordinates, as WKT; empty if the file says nothing
};

/// Reads an ESRI ASCII grid (with the reference in a .prj file beside it, if any) or a GeoTIFF; its content
/// says which. Coordinates must be in metres along the axes. Collective.
Raster read_raster(const Communicator& comm, const std::filesystem::path& file);

/// Writes `raster` of the root in single precision: as GeoTIFF if the name ends in .tif, else as an ESRI
/// ASCII grid with a .prj file. Replaces what is there, never leaving half a file. Collective.
void write_raster(const Communicator& comm, const std::filesystem::path& file, const Raster& raster);

/// Areas with their attributes.
struct Areas {
    std::vector<Polygon> polygons;
    std::string reference;  ///< of the coordinates, as WKT; empty if the file says nothing
};

/// Reads the polygons of a shapefile. Collective.
Areas read_areas(const Communicator& comm, const std::filesystem::path& file);

/// Whether two references mean the same coordinates; true if one of them is empty. Collective.
bool is_same_reference(const Communicator& comm, const std::string& one, const std::string& other);

}  // namespace talus
