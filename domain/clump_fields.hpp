#pragma once
#include "domain/fields.hpp"

namespace talus::field {

// Fields of grains that are spheres of a rigid clump: each carries the state of its whole clump, to the same
// bits as the others, so that a clump belongs to nobody.

inline constexpr Field<double> clump_centre{"clump_centre", "m",   Shape::point,
                                            state,          owner, "centre of mass of the clump"};
inline constexpr Field<double> clump_velocity{
    "clump_velocity", "m s-1", vector, state, owner, "velocity of the clump's centre of mass"};
inline constexpr Field<double> clump_acceleration{
    "clump_acceleration", "m s-2", vector, state, owner, "acceleration of the clump at the last evaluation"};
inline constexpr Field<double> clump_angular_momentum{
    "clump_angular_momentum", "kg m2 s-1", vector, state, owner, "about the clump's centre of mass"};
inline constexpr Field<double> clump_torque{
    "clump_torque", "N m", vector, state, owner, "about the clump's centre of mass at the last evaluation"};
inline constexpr Field<double> orientation_scalar{
    "orientation_scalar",
    "1",
    scalar,
    state,
    owner,
    "scalar part of the unit quaternion that turns the clump's principal axes into place"};
inline constexpr Field<double> orientation_vector{
    "orientation_vector", "1", vector, state, owner, "vector part of that quaternion"};
inline constexpr Field<double> sphere_force{
    "sphere_force", "N", vector, work, halo, "of all contacts of this sphere of a clump"};
inline constexpr Field<double> sphere_torque{
    "sphere_torque", "N m", vector, work, halo, "of all contacts of this sphere about its own centre"};
// Under self-gravity.
inline constexpr Field<double> attracting_mass{
    "attracting_mass",
    "kg",
    scalar,
    state,
    owner,
    "by which a grain attracts and is attracted: of a sphere of a clump its share of the clump's mass"};
inline constexpr Field<double> sphere_attraction{
    "sphere_attraction", "m s-2", vector, work, halo, "acceleration of gravity at this sphere of a clump"};

}  // namespace talus::field
