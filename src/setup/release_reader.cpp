#include "src/setup/release_reader.hpp"

#include <fmt/format.h>

#include <cmath>

#include "io/raster.hpp"

namespace talus {

namespace {

constexpr Range positive{0, std::numeric_limits<double>::infinity(), true};

bool is_drawn(const Section& table) {
    return table.has("areas") || table.has("corners") || table.has("depth_raster");
}

/// Polygons of a file, or one whose corners the scene lists.
std::vector<Polygon> read_polygons(const Section& table, const BodyContext& context,
                                   const SceneTerrain& terrain, std::string& file) {
    if (table.has("areas") && table.has("corners")) table.error("corners", "give areas or corners, not both");
    if (table.has("areas")) {
        file = find_file(context.comm, context.scene, table.text("areas"));
        Areas areas = read_areas(context.comm, file);
        check_reference(context.comm, terrain, table, "areas", file, areas.reference);
        return areas.polygons;
    }
    if (!table.has("corners")) return {};
    const std::vector<double> numbers = table.numbers("corners", "m", 0);
    if (numbers.size() < 6 || numbers.size() % 2 != 0) {
        table.error("corners",
                    fmt::format("has {} numbers; allowed: x and y of at least three corners in turn",
                                numbers.size()));
        return {};
    }
    Polygon polygon;
    polygon.rings.resize(1);
    for (std::size_t k = 0; k < numbers.size(); k += 2)
        polygon.rings[0].push_back({numbers[k], numbers[k + 1]});
    return {polygon};
}

std::shared_ptr<const TerrainGrid> read_depth_raster(const Section& table, const BodyContext& context,
                                                     const SceneTerrain& terrain) {
    const std::string file = find_file(context.comm, context.scene, table.text("depth_raster"));
    const Raster raster = read_raster(context.comm, file);
    check_reference(context.comm, terrain, table, "depth_raster", file, raster.reference);
    const TerrainGrid& grid = raster.grid;
    for (std::size_t k = 0; k < grid.elevations.size(); ++k)
        if (grid.elevations[k] < 0) {
            table.error(
                "depth_raster",
                fmt::format("{}: the depth in column {}, row {} is {:g} m; allowed: not negative", file,
                            k % grid.columns + 1, grid.rows - k / grid.columns, grid.elevations[k]));
            break;
        }
    return std::make_shared<TerrainGrid>(grid);
}

/// Depth of a polygon: a number for all, or an attribute of each.
double depth_of(const Section& table, const Polygon& polygon, const std::string& attribute,
                const std::string& file) {
    const auto found = polygon.numbers.find(attribute);
    if (found != polygon.numbers.end() && found->second > 0) return found->second;
    std::string names;
    for (const auto& [name, value] : polygon.numbers) names += fmt::format(" {} = {:g}", name, value);
    table.error("depth_attribute", fmt::format("{}: a polygon has no positive {}; it has:{}", file, attribute,
                                               names.empty() ? " nothing" : names));
    return 1;
}

void read_spacing(const Section& table, double area, int dimension, double first_spacing, Release& release) {
    if (table.has("particles") && table.has("spacing"))
        table.error("spacing", "give particles or spacing, not both");
    if (table.has("particles")) {
        const auto count = static_cast<double>(table.integer("particles", {}, 1, 2000000000));
        release.spacing = std::pow(area / count, 1.0 / dimension);
    } else {
        release.spacing =
            table.number("spacing", "m",
                         first_spacing > 0 ? std::optional<double>(first_spacing) : std::nullopt, positive);
        constexpr double most = 2e9;
        if (area > most * std::pow(release.spacing, dimension))
            table.error("spacing", fmt::format("makes {:.3g} particles; allowed: {:.3g}",
                                               area / std::pow(release.spacing, dimension), most));
    }
}

/// Depth or level, where no file says it.
void read_depth(const Section& table, Release& release) {
    if (table.has("depth") && table.has("level")) table.error("level", "give depth or level, not both");
    if (table.has("level")) {
        release.level = table.number("level", "m");
        return;
    }
    release.depth = table.number("depth", "m", {}, positive);
}

Polygon outline(const TerrainGrid& grid) {
    std::array<double, 2> low = grid.origin, high = grid.origin;
    const std::array<std::size_t, 2> count{grid.columns, grid.rows};
    for (std::size_t a = 0; a < 2; ++a) {
        low[a] -= grid.spacing[a] / 2;
        high[a] += grid.spacing[a] * (static_cast<double>(count[a]) - 0.5);
    }
    Polygon polygon;
    polygon.rings = {{low, {high[0], low[1]}, high, {low[0], high[1]}}};
    return polygon;
}

std::vector<Release> read_drawn(const Section& table, const BodyContext& context, const SceneTerrain& terrain,
                                const Release& common, double first_spacing) {
    if (context.dimension != 2) {
        table.error("", "areas of a map need dimension = 2");
        return {};
    }
    std::string file;
    std::vector<Polygon> polygons = read_polygons(table, context, terrain, file);
    Release whole = common;
    std::string attribute;
    if (table.has("depth_raster")) {
        whole.depth_raster = read_depth_raster(table, context, terrain);
        if (polygons.empty()) polygons.push_back(outline(*whole.depth_raster));
    } else if (table.has("depth_attribute") && !file.empty()) {
        attribute = table.text("depth_attribute");
    } else {
        read_depth(table, whole);
    }
    double area = 0;
    for (const Polygon& polygon : polygons) area += polygon.area();
    read_spacing(table, area, context.dimension, first_spacing, whole);
    std::vector<Release> releases;
    for (const Polygon& polygon : polygons) {
        Release& release = releases.emplace_back(whole);
        release.area = polygon;
        if (!attribute.empty()) release.depth = depth_of(table, polygon, attribute, file);
    }
    return releases;
}

}  // namespace

std::vector<Release> read_release(const Section& table, const BodyContext& context,
                                  const SceneTerrain& terrain, double first_spacing) {
    Release release;
    release.name = table.text("name", table.path());
    release.velocity = origin_default(table, "velocity", "m s-1", context.dimension);
    if (context.scene.root().has("two_phase"))
        release.solid_fraction = table.number("solid_fraction", "1", {}, {0, 1});
    if (is_drawn(table)) return read_drawn(table, context, terrain, release, first_spacing);
    release.shape = read_shape(table, 1, context);
    const bool round = std::holds_alternative<SphereShape>(release.shape) ||
                       std::holds_alternative<EllipsoidShape>(release.shape);
    read_depth(table, release);
    if (!release.level)
        release.parabolic = table.choice("profile", {"even", "parabolic"}, "even") == "parabolic";
    if (release.parabolic && !round) table.error("profile", "needs a sphere or an ellipsoid; allowed: even");
    read_spacing(table, volume(release.shape, context.dimension), context.dimension, first_spacing, release);
    return {release};
}

}  // namespace talus
