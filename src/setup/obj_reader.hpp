#pragma once
#include <stdexcept>
#include <string>

#include "src/setup/surface_mesh.hpp"

namespace talus {

/// A shape file that cannot be used.
class ShapeError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// The faces in the text of a Wavefront OBJ file as they are, in the file's unit: polygons are cut into
/// triangles and equal vertices made one. Throws ShapeError if the text cannot be read.
Polyhedron parse_obj_faces(const std::string& text);

/// The surface in the text of a Wavefront OBJ file, in the file's unit: polygons are cut into triangles,
/// equal vertices made one, faces without area left out, and a surface seen from inside is turned inside out.
/// Throws ShapeError, saying what is wrong and where, if the text cannot be read or the surface is not
/// closed.
Polyhedron parse_obj(const std::string& text);

}  // namespace talus
