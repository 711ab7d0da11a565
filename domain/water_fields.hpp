#pragma once
#include "domain/fields.hpp"

/// Fields of water (physics/water). What pair loops read of partners is in single precision and in units of
/// the radius of interaction R, the speed of sound c0 and the density at rest rho0, predicted to the time of
/// evaluation: docs/decisions/022-water.md.
namespace talus::water_field {
using enum Shape;
using enum Role;
using enum Reach;

inline constexpr Field<double> density_rate{
    "density_rate", "kg m-3 s-1", scalar, state, owner, "rate of the density at the last evaluation"};
inline constexpr Field<double> shift_velocity{
    "shift_velocity", "m s-1", vector, state, owner, "that places move faster than the water"};
inline constexpr Field<double> wall_force{"wall_force", "N",   vector,
                                          work,         owner, "of the water on a particle of a wall"};
inline constexpr Field<float> partner_velocity{"partner_velocity", "1", vector, work, halo,
                                               "velocity over c0"};
inline constexpr Field<float> partner_volume{
    "partner_volume",
    "1",
    scalar,
    work,
    halo,
    "volume over that of a cube of side R; of particles of walls with the sign changed"};
inline constexpr Field<float> partner_pressure{"partner_pressure",       "1", scalar, work, halo,
                                               "pressure over rho0 c0^2"};
inline constexpr Field<float> partner_density{
    "partner_density",
    "1",
    scalar,
    work,
    halo,
    "of water: density less that of water at rest, over rho0; of walls: 1, or 0 if they slip"};
inline constexpr Field<double> viscosity{
    "viscosity", "Pa s", scalar, work, owner, "effective viscosity at the time of evaluation"};
inline constexpr Field<float> partner_viscosity{"partner_viscosity",       "1", scalar, work, halo,
                                                "viscosity over rho0 c0 R"};
inline constexpr Field<float> partner_gradient{
    "partner_gradient", "1", tensor, work, halo, "gradient of the velocity, dv_a/dx_b, over c0/R"};
}  // namespace talus::water_field
