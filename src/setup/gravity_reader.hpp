#pragma once
#include <optional>

#include "domain/box.hpp"
#include "io/scene.hpp"
#include "physics/gravity/settings.hpp"

namespace talus {

/// The scene's [gravity] table, or nothing if it has none. `root`: the whole scene.
std::optional<gravity::Settings> read_gravity(const Section& root, const Box& box);

}  // namespace talus
