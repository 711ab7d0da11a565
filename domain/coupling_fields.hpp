#pragma once
#include "domain/fields.hpp"

/// Fields of a fluid and grains that act on each other (physics/coupling).
namespace talus::coupling_field {
using enum Shape;
using enum Role;
using enum Reach;

// Of the fluid.
inline constexpr Field<double> quadrature_volume{
    "quadrature_volume",
    "m3",
    scalar,
    work,
    halo,
    "volume with which a fluid particle counts in averages, less than 0 of walls, which do not"};
inline constexpr Field<double> solid_fraction{
    "solid_fraction",
    "1",
    scalar,
    state,
    halo,
    "share of the volume that grains fill around the fluid particle"};
inline constexpr Field<double> shared_fraction{
    "shared_fraction", "1", scalar, work, halo, "the same by the weights that forces are shared with"};
inline constexpr Field<double> pair_acceleration{
    "pair_acceleration", "m s-2", vector, work, halo, "acceleration of pressure and viscosity"};
inline constexpr Field<double> grain_acceleration{"grain_acceleration",
                                                  "m s-2",
                                                  vector,
                                                  state,
                                                  halo,
                                                  "acceleration of the fluid by what it exerts on grains"};

// Of grains among the fluid: copies of the grains, arranged as the fluid is.
inline constexpr Field<std::uint32_t> home_rank{"home_rank", "1",   scalar,
                                                state,       owner, "rank that owns the grain"};
inline constexpr Field<std::uint32_t> home_place{"home_place", "1",   scalar,
                                                 state,        owner, "place of the grain on that rank"};
inline constexpr Field<double> kernel_sum{
    "kernel_sum", "1", scalar, work, halo, "sum of the weights of the fluid around: 1 far within even fluid"};
inline constexpr Field<double> wet_share{"wet_share", "1",  scalar,
                                         work,        halo, "share of a grain's volume that is in the fluid"};
inline constexpr Field<double> exchanged_force{
    "exchanged_force", "N", vector, work, halo, "force of the fluid on the grain"};

// Of grains.
inline constexpr Field<double> fluid_acceleration{
    "fluid_acceleration", "m s-2", vector, state, owner, "force of the fluid on the grain over its mass"};
inline constexpr Field<double> earlier_velocity{
    "earlier_velocity", "m s-1", vector, state, owner, "velocity when the force of the fluid was last found"};
inline constexpr Field<double> earlier_slip{
    "earlier_slip",
    "m s-1",
    vector,
    state,
    owner,
    "velocity of the fluid around less that of the grain when the force of the fluid was last found"};
inline constexpr Field<double> slip_memories{
    "slip_memories", "m s-1",
    profile,         state,
    owner,           "past changes of the slip, forgotten at one rate after another: three components each"};
}  // namespace talus::coupling_field
