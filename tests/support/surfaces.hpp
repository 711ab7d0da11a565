#pragma once
#include <string>

#include "src/setup/surface_mesh.hpp"

namespace talus::test {

/// Icosahedron of circumscribed radius 1, each face cut into four `cuts` times and pushed out to the sphere;
/// faces are seen from outside. Some vertices lie on the axes and in the planes between them.
Polyhedron icosphere(int cuts);

/// Wavefront OBJ text of a surface, with 17 digits.
std::string obj_text(const Polyhedron& surface);

}  // namespace talus::test
