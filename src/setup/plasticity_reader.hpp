#pragma once
#include "io/scene.hpp"
#include "physics/solid/plasticity.hpp"

namespace talus {

/// Whether a [strength] table of that `kind` is one of soil.
bool is_plasticity(const std::string& kind);

/// The keys of a [strength] table of that kind. `dimension`: of the scene. Faults are recorded in the scene.
Plasticity read_plasticity(const Section& table, const std::string& kind, int dimension);

}  // namespace talus
