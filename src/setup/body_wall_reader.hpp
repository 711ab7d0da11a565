#pragma once
#include <optional>

#include "io/scene.hpp"
#include "physics/sph/walls.hpp"

namespace talus {

/// The keys `wall`, `normal` and [motion] of a body; none if it is matter. `has_normal`: what lies on walls
/// that slip is mirrored in them. Faults are recorded in the scene.
std::optional<sph::Wall> read_body_wall(const Section& body, int dimension, bool has_normal = true);

}  // namespace talus
