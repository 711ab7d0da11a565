#include "src/setup/terrain_reader.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "io/raster.hpp"
#include "src/setup/shape_reader.hpp"

namespace talus {

namespace {

/// A plane: its elevation at the origin and where it falls to.
std::shared_ptr<const Terrain> read_plane(const Section& table, int dimension) {
    const double elevation = table.number("elevation", "m", 0.0);
    const double dip = table.number("dip", "rad", 0.0, {0});
    if (dip >= std::numbers::pi / 2) {
        table.error("dip", fmt::format("is {:.4g} degrees; allowed: below 90", dip * 180 / std::numbers::pi));
        return std::make_shared<Terrain>(0.0, std::array<double, 2>{});
    }
    const double azimuth = dimension == 2 ? table.number("dip_direction", "rad", 0.0) : 0;
    const double steepness = std::tan(dip);
    return std::make_shared<Terrain>(
        elevation, std::array<double, 2>{-steepness * std::cos(azimuth),
                                         azimuth == 0 ? 0 : -steepness * std::sin(azimuth)});
}

}  // namespace

SceneTerrain read_terrain(const Communicator& comm, const Scene& scene, const Section& table, int dimension) {
    if (!table.has("file")) return {read_plane(table, dimension), {}, "", ""};
    if (dimension != 2) {
        table.error("file", "a raster needs dimension = 2");
        return {std::make_shared<Terrain>(0.0, std::array<double, 2>{}), {}, "", ""};
    }
    SceneTerrain terrain;
    terrain.file = find_file(comm, scene, table.text("file"));
    Raster raster = read_raster(comm, terrain.file);
    terrain.reference = raster.reference;
    terrain.frame = {.origin = raster.grid.origin,
                     .spacing = raster.grid.spacing,
                     .columns = raster.grid.columns,
                     .rows = raster.grid.rows,
                     .elevations = {}};
    terrain.ground = std::make_shared<Terrain>(std::move(raster.grid));
    return terrain;
}

void check_reference(const Communicator& comm, const SceneTerrain& terrain, const Section& table,
                     std::string_view key, const std::string& file, const std::string& reference) {
    if (!is_same_reference(comm, terrain.reference, reference))
        table.error(
            key, fmt::format("{} has another coordinate reference than the terrain {}; bring both into one",
                             file, terrain.file));
}

}  // namespace talus
