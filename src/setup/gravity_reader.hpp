#pragma once
#include <optional>

#include "domain/box.hpp"
#include "io/scene.hpp"
#include "physics/gravity/settings.hpp"
#include "src/grain_gravity.hpp"

namespace talus {

/// The [gravity] table of a scene of SPH, or nothing if it has none. `root`: the whole scene.
std::optional<gravity::Settings> read_gravity(const Section& root, const Box& box);

/// The same of a scene of grains.
std::optional<SelfGravity> read_grain_gravity(const Section& root, const Box& box);

}  // namespace talus
