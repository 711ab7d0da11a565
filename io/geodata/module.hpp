#pragma once
#include <string>

#include "io/raster.hpp"

namespace talus {

/// What needs GDAL. It is a library of its own, talus_geodata, that is loaded on first use: GDAL brings over
/// a hundred libraries, whose loading takes longer than many a scene (docs/decisions/019). All functions are
/// for one rank and throw std::runtime_error.
struct GeodataModule {
    Raster (*read_geotiff)(const std::string& file);
    std::string (*geotiff)(const Raster& raster);  ///< the bytes of such a file
    Areas (*read_areas)(const std::string& file);
    bool (*is_same_reference)(const std::string& one, const std::string& other);
    /// Why coordinates of this reference are not metres along two axes; empty if they are.
    std::string (*why_not_metres)(const std::string& reference);
};

/// The symbol that the program looks up.
extern "C" const GeodataModule talus_geodata_module;

}  // namespace talus
