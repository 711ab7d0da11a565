#pragma once
#include <optional>

#include "io/scene.hpp"
#include "physics/depth/basal_friction.hpp"
#include "src/depth_simulation.hpp"

namespace talus {

/// The law of the bed that a [friction] table names. Faults are recorded in the scene.
depth::BasalFriction read_basal_friction(const Section& table);

/// The coefficient of friction of a law; 0 if it has none.
double friction_coefficient(const depth::BasalFriction& friction);

/// What a [two_phase] table and [water_friction] say, nothing if there is none. Faults are recorded in the
/// scene.
std::optional<depth::TwoPhase> read_two_phase(const Section& root);

/// What a [pore_pressure] table says, nothing if there is none. Faults are recorded in the scene.
std::optional<PorePressure> read_pore_pressure(const Section& table);

}  // namespace talus
