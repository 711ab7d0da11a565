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

/// A surface without its faces of no area, turned inside out if it is seen from inside. Throws ShapeError,
/// saying what is wrong and where, if it is not closed.
Polyhedron closed_surface(Polyhedron surface);

/// closed_surface() of parse_obj_faces().
Polyhedron parse_obj(const std::string& text);

}  // namespace talus
