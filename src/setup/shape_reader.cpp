#include "src/setup/shape_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "src/setup/material_reader.hpp"
#include "src/setup/obj_reader.hpp"
#include "src/setup/wall_mesh_reader.hpp"

namespace talus {

namespace {

constexpr Range positive{0, std::numeric_limits<double>::infinity(), true};
constexpr Range not_negative{0};

Point read_centre(const Section& table, const BodyContext& context) {
    if (context.in_impact) return {};
    return origin_default(table, "centre", "m", context.dimension);
}

/// At most one of two keys may say the same thing.
void refuse_both(const Section& table, std::string_view key, std::string_view other) {
    if (table.has(key) && table.has(other))
        table.error(other, fmt::format("give {} or {}, not both", key, other));
}

BodyShape read_sphere(const Section& table, double density, const BodyContext& context) {
    SphereShape sphere{read_centre(table, context), 0, table.number("inner_radius", "m", 0.0, not_negative)};
    refuse_both(table, "radius", "mass");
    if (table.has("radius") || !table.has("mass")) sphere.radius = table.number("radius", "m", {}, positive);
    if (table.has("mass")) {
        const double full = table.number("mass", "kg", {}, positive) / density +
                            volume(SphereShape{{}, sphere.inner_radius}, context.dimension);
        sphere.radius =
            std::pow(full / volume(SphereShape{{}, 1}, context.dimension), 1.0 / context.dimension);
    }
    if (sphere.inner_radius >= sphere.radius) table.error("inner_radius", "must be below the radius");
    return sphere;
}

/// Turned about x, then about y, then about z, all fixed in space; in 2D by one angle.
Rotation read_orientation(const Section& table, int dimension) {
    if (dimension == 2) return rotation_about(2, table.number("orientation", "rad", 0.0));
    if (dimension == 1) return {};
    const std::vector<double> angles = table.numbers("orientation", "rad", 3, std::vector<double>(3, 0.0));
    Rotation turn;
    for (std::size_t axis = 0; axis < std::min<std::size_t>(3, angles.size()); ++axis)
        turn = turn.then(rotation_about(axis, angles[axis]));
    return turn;
}

BodyShape read_ellipsoid(const Section& table, double density, const BodyContext& context) {
    EllipsoidShape ellipsoid{read_centre(table, context),
                             read_point(table, "semi_axes", "m", context.dimension),
                             read_orientation(table, context.dimension)};
    for (std::size_t a = 0; a < static_cast<std::size_t>(context.dimension); ++a)
        if (!(ellipsoid.semi_axes[a] > 0)) {
            table.error("semi_axes", "must be positive");
            ellipsoid.semi_axes[a] = 1;
        }
    if (table.has("mass")) {
        const double wanted = table.number("mass", "kg", {}, positive) / density;
        ellipsoid.semi_axes =
            times(std::pow(wanted / volume(ellipsoid, context.dimension), 1.0 / context.dimension),
                  ellipsoid.semi_axes);
    }
    return ellipsoid;
}

/// How many metres one unit of a shape file is, given its volume in that unit.
double read_scale(const Section& table, double density, double file_volume) {
    const bool by_mass = table.has("mass"), by_radius = table.has("mean_radius");
    double scale = 1000;
    if (table.has("file_unit") || (!by_mass && !by_radius))
        scale = table.number("file_unit", "m", 1000.0, positive);
    if (by_radius)
        scale = table.number("mean_radius", "m", {}, positive) /
                std::cbrt(file_volume / (4.0 / 3 * std::numbers::pi));
    if (by_mass) scale = std::cbrt(table.number("mass", "kg", {}, positive) / density / file_volume);
    refuse_both(table, "file_unit", "mean_radius");
    refuse_both(table, "file_unit", "mass");
    refuse_both(table, "mean_radius", "mass");
    return scale;
}

BodyShape read_mesh(const Section& table, double density, const BodyContext& context) {
    const SphereShape harmless{{}, 1};
    const Point middle = read_centre(table, context);
    const std::string name = table.text("file");
    if (context.dimension != 3) {
        table.error("shape", "a surface of triangles needs dimension = 3");
        return harmless;
    }
    const Rotation turn = read_orientation(table, 3);
    if (name.empty()) return harmless;
    const std::string file = find_file(context.comm, context.scene, name);
    try {
        Polyhedron surface = closed_surface(parse_mesh_faces(file, read_shared_text(context.comm, file)));
        const VolumeIntegrals integrals = integrate(surface);
        const double scale = read_scale(table, density, integrals.volume);
        if (!std::isfinite(scale)) return harmless;  // its material is missing
        for (Point& vertex : surface.vertices) vertex = turn(times(scale, minus(vertex, integrals.centroid)));
        return MeshShape{middle, std::make_shared<SurfaceMesh>(std::move(surface))};
    } catch (const ShapeError& error) {
        table.error("file", fmt::format("{}: {}", file, error.what()));
    } catch (const SceneError& error) {
        table.error("file", error.what());
    }
    read_scale(table, density, 1);
    return harmless;
}

}  // namespace

std::string find_file(const Communicator& comm, const Scene& scene, const std::string& name) {
    std::filesystem::path file = std::filesystem::absolute(scene.file()).parent_path() / name;
    if (comm.is_root()) {
        std::error_code unreadable;
        const char* data = std::getenv("TALUS_DATA");
        if (!std::filesystem::exists(file, unreadable) && data)
            if (const auto other = std::filesystem::path(data) / name;
                std::filesystem::exists(other, unreadable))
                file = other;
    }
    return comm.all_broadcast(file.string());
}

Point read_point(const Section& table, std::string_view key, std::string_view unit, int dimension,
                 std::optional<std::vector<double>> default_value) {
    const auto count = static_cast<std::size_t>(dimension);
    if (default_value) default_value->resize(count);
    const std::vector<double> values = table.numbers(key, unit, count, default_value);
    Point point{};
    std::copy_n(values.begin(), std::min(values.size(), count), point.begin());
    return point;
}

Point origin_default(const Section& table, std::string_view key, std::string_view unit, int dimension) {
    return read_point(table, key, unit, dimension, std::vector<double>(3, 0.0));
}

BodyShape read_shape(const Section& table, double density, const BodyContext& context) {
    const std::string kind = table.choice("shape", {"box", "sphere", "ellipsoid", "mesh", "domain"});
    if (kind == "sphere") return read_sphere(table, density, context);
    if (kind == "ellipsoid") return read_ellipsoid(table, density, context);
    if (kind == "mesh") return read_mesh(table, density, context);
    if (context.in_impact) {
        table.error("shape", "a body of [impact] must be a sphere, an ellipsoid or a mesh");
        return SphereShape{{}, 1};
    }
    if (kind == "domain") return context.domain;
    BoxShape box{read_point(table, "lower", "m", context.dimension),
                 read_point(table, "upper", "m", context.dimension)};
    for (std::size_t a = 0; a < static_cast<std::size_t>(context.dimension); ++a)
        if (!(box.lower[a] < box.upper[a])) {
            table.error("upper", fmt::format("must be above lower along {}", "xyz"[a]));
            box.upper[a] = box.lower[a] + 1;
        }
    return box;
}

}  // namespace talus
