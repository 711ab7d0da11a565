#pragma once
#include "comm/communicator.hpp"
#include "io/scene.hpp"
#include "physics/solid/material.hpp"
#include "src/setup/bodies.hpp"

namespace talus {

/// A body's table: shape, resolution and state at the start. `domain` is what shape = "domain" fills (the
/// whole box). Faults are recorded in the scene.
Body read_body(const Section& table, const Material& material, int dimension, const BoxShape& domain,
               double first_spacing);

}  // namespace talus
