#include "src/setup/wall_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "src/setup/material_reader.hpp"
#include "src/setup/names.hpp"
#include "src/setup/shape_reader.hpp"
#include "src/setup/wall_mesh_reader.hpp"

namespace talus {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double usual_smooth_angle = 0.5;  // [rad]

dem::Vector3<> vector_of(const Point& p) { return {p[0], p[1], p[2]}; }

dem::Vector3<> read_vector(const Section& table, std::string_view key, std::string_view unit,
                           int dimension = 3) {
    return vector_of(read_point(table, key, unit, dimension));
}

dem::Vector3<> read_direction(const Section& table, std::string_view key, int dimension = 3) {
    const dem::Vector3<> given = read_vector(table, key, "1", dimension);
    const double length = norm(given);
    if (length > 0) return (1 / length) * given;
    table.error(key, "must have a length above 0");
    return {0, 0, 1};
}

dem::WallShape read_plane(const Section& table, const Box& box) {
    const dem::PlaneShape plane{read_vector(table, "point", "m", box.dimension),
                                read_direction(table, "normal", box.dimension)};
    const std::array<double, 3> normal{plane.normal.x, plane.normal.y, plane.normal.z};
    for (std::size_t a = 0; a < 3; ++a)
        if (box.boundary[a] == Boundary::periodic && normal[a] != 0)
            table.error("normal", fmt::format("must be 0 along {}, where the box is periodic", "xyz"[a]));
    return plane;
}

/// In 2D without ends along z.
template <class Shape>
dem::WallShape read_corners(const Section& table, int dimension) {
    Shape shape{read_vector(table, "lower", "m", dimension), read_vector(table, "upper", "m", dimension)};
    if (dimension == 2) {
        constexpr double far_away = 1e100;
        shape.lower.z = -far_away;
        shape.upper.z = far_away;
    }
    if (!(shape.lower.x < shape.upper.x && shape.lower.y < shape.upper.y && shape.lower.z < shape.upper.z))
        table.error("upper", "must be above lower along every axis");
    return shape;
}

dem::WallShape read_revolved(const Section& table) {
    const dem::Vector3<> origin = vector_of(origin_default(table, "origin", "m", 3)),
                         axis = read_direction(table, "axis");
    const std::vector<double> radii = table.numbers("radii", "m", 0),
                              along = table.numbers("heights", "m", 0);
    std::vector<dem::RevolvedShape::ProfilePoint> profile;
    bool good = radii.size() == along.size() && radii.size() >= 2;
    for (std::size_t k = 0; good && k < radii.size(); ++k) {
        good = radii[k] >= 0 && (k == 0 || radii[k] != radii[k - 1] || along[k] != along[k - 1]);
        profile.push_back({radii[k], along[k]});
    }
    const double smooth = table.number("smooth_angle", "rad", usual_smooth_angle, {0, 1.5});
    if (good) return dem::RevolvedShape(origin, axis, profile, smooth);
    table.error(
        "radii",
        "radii and heights must be as many, two at least, no radius below 0, no point twice in sequence");
    return dem::RevolvedShape(origin, axis, {{1, 0}, {1, 1}}, smooth);
}

/// A sheet of triangles from an STL or OBJ file; any sheet if that has a fault.
dem::WallShape read_sheet(const Section& table, const WallContext& context, const std::string& wall,
                          std::vector<std::string>& warnings) {
    const std::string name = table.text("file");
    const double scale = table.number("file_unit", "m", 1.0, {0, infinity, true});
    const double smooth = table.number("smooth_angle", "rad", usual_smooth_angle, {0, 1.5});
    const dem::TriangleMesh any{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    const double reach = context.largest_radius > 0 ? 1.3 * context.largest_radius : 1.0;
    const auto surface = [&](dem::TriangleMesh mesh) {
        return std::make_shared<const dem::TriangleSurface>(std::move(mesh), smooth, reach);
    };
    if (name.empty()) return surface(any);
    const std::string file = find_file(context.comm, context.scene, name);
    try {
        WallMesh read = read_wall_mesh(file, read_shared_text(context.comm, file), scale);
        for (const std::string& warning : read.warnings)
            warnings.push_back(fmt::format("wall '{}': {} {}", wall, file, warning));
        if (const std::string outside = outside_of(read.mesh, context.box); !outside.empty())
            warnings.push_back(fmt::format("wall '{}': {} {}", wall, file, outside));
        return surface(std::move(read.mesh));
    } catch (const ShapeError& error) {
        table.error("file", fmt::format("{}: {}", file, error.what()));
    } catch (const SceneError& error) {
        table.error("file", error.what());
    }
    return surface(any);
}

/// A wall that is not the same everywhere along a periodic axis would be met by grains inside the box and
/// missed by their images.
void refuse_in_periodic(const Section& table, const Box& box, const std::string& kind,
                        const dem::WallMotion& motion) {
    if (std::find(box.boundary.begin(), box.boundary.end(), Boundary::periodic) == box.boundary.end()) return;
    if (kind != "plane")
        table.error("kind",
                    fmt::format("'{}' needs a box that is open along all axes (allowed here: plane)", kind));
    else if (motion.angular_velocity != 0)
        table.section("motion").error("angular_velocity",
                                      "a wall that turns needs a box that is open along all axes");
}

}  // namespace

dem::WallMotion read_motion(const Section& table, int dimension) {
    dem::WallMotion motion;
    if (!table.exists()) return motion;
    motion.velocity = vector_of(origin_default(table, "velocity", "m/s", dimension));
    motion.amplitude = vector_of(origin_default(table, "amplitude", "m", dimension));
    if (norm(motion.amplitude) > 0)
        motion.translation_oscillation.frequency = table.number("frequency", "Hz", {}, {0});
    if (table.has("angular_velocity")) {
        motion.angular_velocity = table.number("angular_velocity", "rad/s");
        motion.centre = vector_of(origin_default(table, "centre", "m", dimension));
        if (dimension == 3) motion.axis = read_direction(table, "axis");
    }
    motion.begin = table.number("begin", "s", 0.0);
    if (table.has("end")) motion.end = table.number("end", "s");
    if (motion.end < motion.begin) table.error("end", "must not be before begin");
    return motion;
}

std::vector<dem::Wall> read_walls(const WallContext& context, GrainLawReader& laws,
                                  std::vector<std::string>& warnings) {
    std::vector<dem::Wall> walls;
    for (const Section& table : context.scene.root().sections("wall")) {
        const int dimension = context.box.dimension;
        const std::string kind =
            dimension == 2
                ? table.choice("kind", {"plane", "container", "block"}, "plane")
                : table.choice("kind", {"plane", "container", "block", "revolved", "mesh"}, "plane");
        const std::string name = table.text("name", table.path());
        refuse_same_name(table, walls, name);
        dem::WallShape shape;
        if (kind == "container")
            shape = read_corners<dem::ContainerShape>(table, dimension);
        else if (kind == "block")
            shape = read_corners<dem::BlockShape>(table, dimension);
        else if (kind == "revolved")
            shape = read_revolved(table);
        else if (kind == "mesh")
            shape = read_sheet(table, context, name, warnings);
        else
            shape = read_plane(table, context.box);
        const dem::WallMotion motion = read_motion(table.section("motion"), dimension);
        refuse_in_periodic(table, context.box, kind, motion);
        walls.push_back({name, laws.material(table), shape, motion});
    }
    return walls;
}

std::vector<std::string> names_of_walls(const std::vector<dem::Wall>& walls) {
    constexpr std::array<const char*, std::variant_size_v<dem::WallShape>> kinds = {
        "plane", "container", "block", "revolved", "mesh"};
    std::vector<std::string> names;
    for (const dem::Wall& wall : walls)
        names.push_back(fmt::format("{} ({})", wall.name, kinds[wall.shape.index()]));
    return names;
}

}  // namespace talus
