#define TINYOBJLOADER_USE_DOUBLE
#include "src/setup/obj_reader.hpp"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <cmath>
#include <map>

namespace talus {

namespace {

/// The library reads what is no number as zero.
void refuse_bad_vertices(const std::string& text) {
    std::size_t line = 0;
    for (std::size_t start = 0; start < text.size(); ++line) {
        const std::size_t end = std::min(text.find('\n', start), text.size());
        if (text.compare(start, 2, "v ") == 0) {
            const char* at = text.c_str() + start + 2;
            for (int k = 0; k < 3; ++k) {
                char* after = nullptr;
                const double value = std::strtod(at, &after);
                if (after == at || after > text.c_str() + end || !std::isfinite(value))
                    throw ShapeError(fmt::format("line {}: '{}' is not a vertex of three numbers", line + 1,
                                                 text.substr(start, end - start)));
                at = after;
            }
        }
        start = end + 1;
    }
}

}  // namespace

Polyhedron parse_obj_faces(const std::string& text) {
    refuse_bad_vertices(text);
    tinyobj::ObjReaderConfig config;
    config.vertex_color = false;
    tinyobj::ObjReader reader;
    if (!reader.ParseFromString(text, "", config)) throw ShapeError("cannot be read: " + reader.Error());

    const std::vector<double>& coordinates = reader.GetAttrib().vertices;
    Polyhedron surface;
    std::map<Point, std::uint32_t> known;
    std::vector<std::uint32_t> vertex_of;
    for (std::size_t k = 0; k + 2 < coordinates.size(); k += 3) {
        const Point vertex{coordinates[k], coordinates[k + 1], coordinates[k + 2]};
        const auto [at, is_new] = known.try_emplace(vertex, surface.vertices.size());
        if (is_new) surface.vertices.push_back(vertex);
        vertex_of.push_back(at->second);
    }
    for (const tinyobj::shape_t& shape : reader.GetShapes())
        for (std::size_t k = 0; k + 2 < shape.mesh.indices.size(); k += 3) {
            Polyhedron::Triangle triangle{};
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const int index = shape.mesh.indices[k + corner].vertex_index;
                if (index < 0 || static_cast<std::size_t>(index) >= vertex_of.size())
                    throw ShapeError(
                        fmt::format("a face names vertex {}, but there are {}", index + 1, vertex_of.size()));
                triangle[corner] = vertex_of[static_cast<std::size_t>(index)];
            }
            surface.triangles.push_back(triangle);
        }
    return surface;
}

Polyhedron parse_obj(const std::string& text) { return closed_surface(parse_obj_faces(text)); }

Polyhedron closed_surface(Polyhedron surface) {
    std::erase_if(surface.triangles,
                  [](const Polyhedron::Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
    if (const std::string why = why_not_closed(surface); !why.empty()) throw ShapeError(why);
    const double volume = integrate(surface).volume;
    if (volume == 0) throw ShapeError("encloses no volume");
    if (volume < 0)
        for (Polyhedron::Triangle& triangle : surface.triangles) std::swap(triangle[1], triangle[2]);
    return surface;
}

}  // namespace talus
