#include "src/setup/wall_reader.hpp"

#include <fmt/format.h>

#include <cmath>

#include "src/setup/shape_reader.hpp"

namespace talus {

namespace {

dem::Vector3<> vector_of(const Point& p) { return {p[0], p[1], p[2]}; }

dem::Vector3<> read_vector(const Section& table, std::string_view key, std::string_view unit) {
    return vector_of(read_point(table, key, unit, 3));
}

dem::Vector3<> read_direction(const Section& table, std::string_view key) {
    const dem::Vector3<> given = read_vector(table, key, "1");
    const double length = norm(given);
    if (length > 0) return (1 / length) * given;
    table.error(key, "must have a length above 0");
    return {0, 0, 1};
}

dem::WallShape read_plane(const Section& table, const Box& box) {
    const dem::PlaneShape plane{read_vector(table, "point", "m"), read_direction(table, "normal")};
    const std::array<double, 3> normal{plane.normal.x, plane.normal.y, plane.normal.z};
    for (std::size_t a = 0; a < 3; ++a)
        if (box.boundary[a] == Boundary::periodic && normal[a] != 0)
            table.error("normal", fmt::format("must be 0 along {}, where the box is periodic", "xyz"[a]));
    return plane;
}

template <class Shape>
dem::WallShape read_corners(const Section& table) {
    const Shape shape{read_vector(table, "lower", "m"), read_vector(table, "upper", "m")};
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
    const double smooth = table.number("smooth_angle", "rad", 0.5, {0, 1.5});
    if (good) return dem::RevolvedShape(origin, axis, profile, smooth);
    table.error(
        "radii",
        "radii and heights must be as many, two at least, no radius below 0, no point twice in sequence");
    return dem::RevolvedShape(origin, axis, {{1, 0}, {1, 1}}, smooth);
}

dem::WallMotion read_motion(const Section& table) {
    dem::WallMotion motion;
    if (!table.exists()) return motion;
    motion.velocity = vector_of(origin_default(table, "velocity", "m/s", 3));
    motion.amplitude = vector_of(origin_default(table, "amplitude", "m", 3));
    if (norm(motion.amplitude) > 0)
        motion.translation_oscillation.frequency = table.number("frequency", "Hz", {}, {0});
    if (table.has("angular_velocity")) {
        motion.angular_velocity = table.number("angular_velocity", "rad/s");
        motion.centre = vector_of(origin_default(table, "centre", "m", 3));
        motion.axis = read_direction(table, "axis");
    }
    motion.begin = table.number("begin", "s", 0.0);
    if (table.has("end")) motion.end = table.number("end", "s");
    if (motion.end < motion.begin) table.error("end", "must not be before begin");
    return motion;
}

}  // namespace

std::vector<dem::Wall> read_walls(const Scene& scene, const Box& box, GrainLawReader& laws) {
    std::vector<dem::Wall> walls;
    for (const Section& table : scene.root().sections("wall")) {
        const std::string kind = table.choice("kind", {"plane", "container", "block", "revolved"}, "plane");
        dem::WallShape shape;
        if (kind == "container")
            shape = read_corners<dem::ContainerShape>(table);
        else if (kind == "block")
            shape = read_corners<dem::BlockShape>(table);
        else if (kind == "revolved")
            shape = read_revolved(table);
        else
            shape = read_plane(table, box);
        walls.push_back({table.text("name", table.path()), laws.material(table), shape,
                         read_motion(table.section("motion"))});
    }
    return walls;
}

}  // namespace talus
