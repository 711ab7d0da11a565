#pragma once
#include <optional>
#include <string_view>

#include "io/scene.hpp"
#include "physics/solid/plasticity.hpp"

namespace talus {

/// An angle from 0 to less than 90 degrees [rad].
double read_angle(const Section& table, std::string_view key, std::optional<double> default_value = {});

/// The key `cone`; the default suits the dimension of the scene.
ConeMatch read_cone_match(const Section& table, int dimension);

/// Records a fault where flow would gain energy: dilation [rad] beyond the friction, of the key `key`.
void refuse_dilation_above_friction(const Section& table, std::string_view key, double dilation_angle,
                                    double friction_angle);

/// Whether a [strength] table of that `kind` is one of soil.
bool is_plasticity(const std::string& kind);

/// The keys of a [strength] table of that kind. `dimension`: of the scene. Faults are recorded in the scene.
Plasticity read_plasticity(const Section& table, const std::string& kind, int dimension);

}  // namespace talus
