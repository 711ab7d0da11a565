#include "src/setup/results_reader.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <set>

namespace talus {

namespace {

constexpr Range positive{0, std::numeric_limits<double>::infinity(), true};

/// Cells of a given size that cover a rectangle.
TerrainGrid read_frame(const Section& table) {
    const std::vector<double> lower = table.numbers("lower", "m", 2), upper = table.numbers("upper", "m", 2);
    const double cell = table.number("cell", "m", {}, positive);
    if (lower.size() != 2 || upper.size() != 2) return {};
    TerrainGrid frame{.origin = {lower[0] + cell / 2, lower[1] + cell / 2},
                      .spacing = {cell, cell},
                      .columns = 0,
                      .rows = 0,
                      .elevations = {}};
    const double columns = std::ceil((upper[0] - lower[0]) / cell),
                 rows = std::ceil((upper[1] - lower[1]) / cell);
    constexpr double most = 1e9;
    if (!(columns >= 1 && rows >= 1 && columns * rows <= most)) {
        table.error("cell", fmt::format("makes {:g} x {:g} cells; allowed: 1 to 1e9 in all", columns, rows));
        return {};
    }
    frame.columns = static_cast<std::size_t>(columns);
    frame.rows = static_cast<std::size_t>(rows);
    return frame;
}

}  // namespace

ResultsPlan read_results(const Section& root, const SceneTerrain& terrain, int dimension) {
    const Section table = root.section("results");
    ResultsPlan plan;
    if (!table.exists()) return plan;
    if (dimension != 2) {
        table.error("", "rasters need dimension = 2");
        return plan;
    }
    plan.is_geotiff = table.choice("format", {"geotiff", "ascii"}, "geotiff") == "geotiff";
    plan.threshold = table.number("threshold", "m", 0.05, {0});
    plan.reference = terrain.reference;
    plan.frame = terrain.ground->is_plane() || table.has("cell") ? read_frame(table) : terrain.frame;
    return plan;
}

std::vector<Gauge> read_gauge_places(const Section& root, const Terrain& terrain, int dimension) {
    std::vector<Gauge> gauges;
    std::set<std::string> names;
    for (const Section& table : root.sections("gauge")) {
        const std::string name = table.text("name");
        const std::vector<double> place = table.numbers("place", "m", 2);
        if (dimension != 2) table.error("", "a gauge needs dimension = 2");
        if (!names.insert(name).second) table.error("name", fmt::format("'{}' is taken", name));
        if (place.size() != 2) continue;
        if (!terrain.contains(place[0], place[1]))
            table.error("place", fmt::format("({:.6g}, {:.6g}) m is not on the terrain", place[0], place[1]));
        gauges.push_back({name, {place[0], place[1]}});
    }
    return gauges;
}

}  // namespace talus
