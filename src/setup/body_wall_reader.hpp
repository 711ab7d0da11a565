#pragma once
#include <optional>

#include "io/scene.hpp"
#include "physics/sph/walls.hpp"

namespace talus {

/// The keys `wall`, `normal` and [motion] of a body; none if it is matter. Faults are recorded in the scene.
std::optional<sph::Wall> read_body_wall(const Section& body, int dimension);

}  // namespace talus
