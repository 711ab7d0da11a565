#pragma once
#include <string>
#include <vector>

#include "domain/box.hpp"
#include "physics/dem/walls/triangle_surface.hpp"
#include "src/setup/obj_reader.hpp"

namespace talus {

/// A mesh as read, and what is to be said of it.
struct WallMesh {
    dem::TriangleMesh mesh;
    std::vector<std::string> warnings;  ///< what is wrong with it, with numbers: it can be used all the same
};

/// The faces in the content of a mesh file as they are, in the file's unit: STL (binary or text) if its name
/// ends in .stl, OBJ if in .obj. Equal vertices are made one. Throws ShapeError if the content cannot be
/// read.
Polyhedron parse_mesh_faces(const std::string& file_name, const std::string& content);

/// The same, in the file's unit times `scale`; triangles without area are left out with a
/// warning, open edges (holes and rims) and edges of more than two triangles are warned of. Throws ShapeError
/// if the content cannot be read, holds numbers that are not finite or leaves no triangle.
WallMesh read_wall_mesh(const std::string& file_name, const std::string& content, double scale);

/// How much of a mesh lies outside the box, where no grain can meet it; empty if all lies within or on it.
std::string outside_of(const dem::TriangleMesh& mesh, const Box& box);

}  // namespace talus
