#include "src/setup/terrain_reader.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "domain/terrain_smoothing.hpp"
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

double linear(const std::vector<double>& profile, double x) {
    std::size_t k = 2;
    while (k + 2 < profile.size() && profile[k] < x) k += 2;
    const double share = (x - profile[k - 2]) / (profile[k] - profile[k - 2]);
    return profile[k - 1] + share * (profile[k + 1] - profile[k - 1]);
}

/// Length of `smoothing`, such that its means are of no more points than a map has.
double read_smoothing(const Section& table, const TerrainGrid& grid) {
    const double longest = std::min(grid.spacing[0] * static_cast<double>(grid.columns),
                                    grid.spacing[1] * static_cast<double>(grid.rows));
    return table.number("smoothing", "m", 0.0, {0, longest});
}

/// A ground whose elevation changes along x only, by straight lines that the interpolation between cells
/// rounds off.
SceneTerrain read_profile(const Section& table) {
    SceneTerrain terrain{std::make_shared<Terrain>(0.0, std::array<double, 2>{}), {}, "", ""};
    const std::vector<double> profile = table.numbers("profile", "m", 0),
                              width = table.numbers("width", "m", 2);
    const double cell = table.number("cell", "m", {}, {0, std::numeric_limits<double>::infinity(), true});
    bool grows = profile.size() >= 4 && profile.size() % 2 == 0;
    for (std::size_t k = 2; grows && k < profile.size(); k += 2) grows = profile[k - 2] < profile[k];
    if (!grows) table.error("profile", "allowed: x and z of at least two points in turn, x growing");
    if (width.size() == 2 && !(width[0] < width[1]))
        table.error("width", "allowed: least y, then greatest y");
    if (!grows || width.size() != 2 || !(width[0] < width[1])) return terrain;
    const std::array<double, 2> length{profile[profile.size() - 2] - profile[0], width[1] - width[0]};
    const std::array<double, 2> cells{std::ceil(length[0] / cell * (1 - 1e-12)),
                                      std::ceil(length[1] / cell * (1 - 1e-12))};
    constexpr double most = 1e8;
    if (!(cells[0] * cells[1] <= most)) {
        table.error("cell", fmt::format("makes {:.3g} cells; allowed: {:.3g}", cells[0] * cells[1], most));
        return terrain;
    }
    TerrainGrid& frame = terrain.frame;
    frame.origin = {profile[0], width[0]};
    frame.spacing = {length[0] / cells[0], length[1] / cells[1]};
    frame.columns = static_cast<std::size_t>(cells[0]) + 1;
    frame.rows = static_cast<std::size_t>(cells[1]) + 1;
    TerrainGrid grid = frame;
    for (std::size_t row = 0; row < frame.rows; ++row)
        for (std::size_t column = 0; column < frame.columns; ++column)
            grid.elevations.push_back(
                linear(profile, profile[0] + frame.spacing[0] * static_cast<double>(column)));
    const double smoothing = read_smoothing(table, grid);
    terrain.ground = std::make_shared<Terrain>(smoothed(std::move(grid), smoothing));
    return terrain;
}

}  // namespace

SceneTerrain read_terrain(const Communicator& comm, const Scene& scene, const Section& table, int dimension) {
    if (table.has("profile")) return read_profile(table);
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
    const double smoothing = read_smoothing(table, raster.grid);
    terrain.ground = std::make_shared<Terrain>(smoothed(std::move(raster.grid), smoothing));
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
