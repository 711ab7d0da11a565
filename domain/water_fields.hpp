#pragma once
#include "domain/fields.hpp"

/// Fields of water (physics/water).
namespace talus::water_field {
using enum Shape;
using enum Role;
using enum Reach;

inline constexpr Field<double> density_rate{
    "density_rate", "kg m-3 s-1", scalar, state, owner, "rate of the density at the last evaluation"};
inline constexpr Field<double> partner_volume{
    "partner_volume",
    "m3",
    scalar,
    work,
    halo,
    "volume at the time of evaluation; of particles of walls with the sign changed"};
inline constexpr Field<double> effective_viscosity{
    "effective_viscosity", "Pa s", scalar, work, halo, "viscosity at the particle's rate of shear"};
}  // namespace talus::water_field
