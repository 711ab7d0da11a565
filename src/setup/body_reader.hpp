#pragma once
#include "physics/solid/material.hpp"
#include "src/setup/shape_reader.hpp"

namespace talus {

/// What a body's table says of its form: shape, resolution and motion at the start. `density`: by default.
/// Faults are recorded in the scene. Collective.
Body read_body_form(const Section& table, double density, const BodyContext& context);

/// A body's table: shape, resolution and state at the start. Faults are recorded in the scene. Collective.
Body read_body(const Section& table, const Material& material, const BodyContext& context);

/// Angular velocity from `spin`, or from `spin_period` and `spin_axis` [rad/s].
Point read_spin(const Section& table, int dimension);

}  // namespace talus
