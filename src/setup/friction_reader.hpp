#pragma once
#include "io/scene.hpp"
#include "physics/depth/basal_friction.hpp"

namespace talus {

/// The table [friction]: resistance of the bed to a depth-integrated flow. Faults are recorded in the scene.
depth::BasalFriction read_basal_friction(const Section& table);

/// Friction coefficient of a law that has one, else 0.
double friction_coefficient(const depth::BasalFriction& friction);

}  // namespace talus
