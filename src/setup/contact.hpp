#pragma once
#include <optional>

#include "src/setup/shapes.hpp"

namespace talus {

/// Distance at which two shapes touch when the second comes in along a line: the least d such that they do
/// not overlap for any greater one, with the centre of the second at centre(first) + d direction + aside.
/// `direction`: unit vector; `aside`: across it. To 1e-4 of the smaller shape, exact for two spheres. Nothing
/// if they pass each other.
std::optional<double> contact_distance(const BodyShape& first, const BodyShape& second,
                                       const Point& direction, const Point& aside, int dimension);

}  // namespace talus
