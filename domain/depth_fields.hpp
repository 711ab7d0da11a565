#pragma once
#include "domain/fields.hpp"

namespace talus::field {

// Fields of depth-integrated flows, besides those of fields.hpp. A particle is a column of the flow; its
// position, velocity and smoothing length are those in plan.

inline constexpr Field<double> volume{"volume", "m3", scalar,
                                      state,    halo, "volume of the column, in 1D for each metre of width"};
inline constexpr Field<double> depth{
    "depth",
    "m",
    scalar,
    state,
    halo,
    "depth of the flow along the vertical, or along the normal of the bed if "
    "the model is fitted to the bed"};
inline constexpr Field<double> bed_slope{"bed_slope", "1", vector, state, owner, "slope of the bed"};
inline constexpr Field<double> apparent_gravity{
    "apparent_gravity",
    "m s-2",
    scalar,
    state,
    owner,
    "gravity and what the curvature of the bed asks of the velocity, along the vertical"};
inline constexpr Field<double> still_acceleration{
    "still_acceleration",
    "m s-2",
    vector,
    state,
    owner,
    "what the sums over columns make of a lake that should stay at rest, taken off the acceleration"};

inline constexpr Field<double> earth_pressure{
    "earth_pressure", "1", scalar, state, owner, "coefficient of lateral earth pressure"};

inline constexpr Field<double> column_height{
    "column_height", "m", scalar, work, owner, "kernel sum of the volumes around: volume for each plan area"};
inline constexpr Field<double> grad_h_volume{
    "grad_h_volume",
    "m3",
    scalar,
    work,
    halo,
    "what the varying smoothing length of a column takes off the volumes of its partners in gradients"};
inline constexpr Field<double> pressure_factor{"pressure_factor",
                                               "m s-2",
                                               scalar,
                                               work,
                                               halo,
                                               "of a column's own kernel in the pressure between columns"};
inline constexpr Field<double> wave_speed{"wave_speed", "m s-1", scalar,
                                          work,         halo,    "speed of long waves in plan"};
inline constexpr Field<double> signal_speed{
    "signal_speed", "m s-1",
    scalar,         work,
    owner,          "greatest speed of approach of a signal from a partner, less beyond the own kernel"};
inline constexpr Field<double> surface_level{
    "surface_level", "m", scalar, work, halo, "elevation of the free surface"};
inline constexpr Field<double> divergence{"divergence", "s-1", scalar,
                                          work,         owner, "divergence of the velocity in plan"};

}  // namespace talus::field
