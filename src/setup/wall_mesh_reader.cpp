#include "src/setup/wall_mesh_reader.hpp"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <map>

namespace talus {

namespace {

std::string ending_of(const std::string& file_name) {
    const std::size_t dot = file_name.find_last_of('.');
    std::string ending = dot == std::string::npos ? "" : file_name.substr(dot + 1);
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
    return ending;
}

Polyhedron parse_stl(const std::string& content) {
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFileFromMemory(content.data(), content.size(), 0, "stl");
    if (scene == nullptr) throw ShapeError(fmt::format("cannot be read: {}", importer.GetErrorString()));
    Polyhedron surface;
    std::map<Point, std::uint32_t> known;
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
        const aiMesh& part = *scene->mMeshes[m];
        for (unsigned f = 0; f < part.mNumFaces; ++f) {
            const aiFace& face = part.mFaces[f];
            if (face.mNumIndices != 3) continue;
            Polyhedron::Triangle triangle{};
            for (unsigned k = 0; k < 3; ++k) {
                const aiVector3D& v = part.mVertices[face.mIndices[k]];
                // 0.0f: no negative zeros, whose bits differ from those of their equals.
                const Point vertex{v.x + 0.0F, v.y + 0.0F, v.z + 0.0F};
                const auto [at, is_new] = known.try_emplace(vertex, surface.vertices.size());
                if (is_new) surface.vertices.push_back(vertex);
                triangle[k] = at->second;
            }
            surface.triangles.push_back(triangle);
        }
    }
    return surface;
}

}  // namespace

Polyhedron parse_mesh_faces(const std::string& file_name, const std::string& content) {
    const std::string ending = ending_of(file_name);
    if (ending == "stl") return parse_stl(content);
    if (ending == "obj") return parse_obj_faces(content);
    throw ShapeError(fmt::format("'.{}' is no mesh file that can be read: .stl or .obj", ending));
}

WallMesh read_wall_mesh(const std::string& file_name, const std::string& content, double scale) {
    Polyhedron surface = parse_mesh_faces(file_name, content);
    if (surface.triangles.empty()) throw ShapeError("has no triangles");

    WallMesh read;
    for (const Point& vertex : surface.vertices) {
        if (!std::isfinite(vertex[0]) || !std::isfinite(vertex[1]) || !std::isfinite(vertex[2]))
            throw ShapeError(fmt::format("has a vertex ({}, {}, {})", vertex[0], vertex[1], vertex[2]));
        read.mesh.vertices.push_back({scale * vertex[0], scale * vertex[1], scale * vertex[2]});
    }
    read.mesh.triangles = std::move(surface.triangles);
    const std::size_t all = read.mesh.triangles.size();
    const dem::MeshDefects defects = dem::find_defects(read.mesh);
    if (defects.without_area == all)
        throw ShapeError(fmt::format("none of its {} triangles has an area", all));
    if (defects.without_area > 0) {
        dem::remove_triangles_without_area(read.mesh);
        read.warnings.push_back(
            fmt::format("{} of {} triangles have no area and are left out", defects.without_area, all));
    }
    if (defects.open_edges > 0)
        read.warnings.push_back(fmt::format(
            "is not closed: {} edges belong to one triangle only, one of them at ({:g}, {:g}, {:g}) m",
            defects.open_edges, defects.open_edge.x, defects.open_edge.y, defects.open_edge.z));
    if (defects.crowded_edges > 0)
        read.warnings.push_back(
            fmt::format("{} edges belong to more than two triangles", defects.crowded_edges));
    return read;
}

std::string outside_of(const dem::TriangleMesh& mesh, const Box& box) {
    std::size_t outside = 0;
    const auto beyond = [&](const dem::Vector3<>& v) {
        const std::array<double, 3> place{v.x, v.y, v.z};
        for (std::size_t a = 0; a < 3; ++a)
            if (box.boundary[a] != Boundary::open && (place[a] < box.lower[a] || place[a] > box.upper[a]))
                return true;
        return false;
    };
    for (const dem::TriangleMesh::Triangle& triangle : mesh.triangles)
        outside +=
            std::ranges::any_of(triangle, [&](std::uint32_t v) { return beyond(mesh.vertices[v]); }) ? 1 : 0;
    if (outside == 0) return {};
    return fmt::format("{} of {} triangles reach outside the box", outside, mesh.triangles.size());
}

}  // namespace talus
