#pragma once
#include "domain/fields.hpp"

namespace talus::field {

// Fields of grains and of their contacts, besides those of fields.hpp.

inline constexpr Field<double> angular_acceleration{
    "angular_acceleration", "rad s-2", vector, state, owner, "angular acceleration at the last evaluation"};
inline constexpr Field<std::uint64_t> copied_id{"copied_id", "1",  scalar,
                                                work,        halo, "the id, for copies to have it too"};
inline constexpr Field<std::uint64_t> first_id{
    "first_id", "1", scalar, state, owner, "lower id of the two grains in contact; the grain at a wall"};
inline constexpr Field<std::uint64_t> second_id{
    "second_id", "1",   scalar,
    state,       owner, "higher id of the two grains in contact; 2^63 + 2^32 wall + place at a wall"};
inline constexpr Field<double> sliding{
    "sliding", "m",   vector,
    state,     owner, "tangential displacement of the contact, as the first grain sees it"};
inline constexpr Field<double> rolling{
    "rolling", "rad", vector, state, owner, "rolling angle of the contact, as the first grain sees it"};
inline constexpr Field<double> normal{"normal", "1",   vector,
                                      state,    owner, "unit vector of the contact to the first grain"};
inline constexpr Field<double> contact_force{
    "contact_force", "N", vector, state, owner, "force of the contact on the first grain"};
inline constexpr Field<double> overlap{
    "overlap", "m", scalar, state, owner, "depth by which the two overlap, negative across a gap"};
inline constexpr Field<double> twisting{"twisting", "rad", scalar,
                                        state,      owner, "twist of the contact or bond"};
inline constexpr Field<double> adhering{
    "adhering", "1", scalar, state, owner, "1 if the surfaces have touched and have not torn since"};

// Of scenes with bonds.
inline constexpr Field<double> half_step_velocity{
    "half_step_velocity", "m s-1", vector, work, halo, "velocity at the middle of the step"};
inline constexpr Field<double> half_step_angular_velocity{"half_step_angular_velocity",
                                                          "rad s-1",
                                                          vector,
                                                          work,
                                                          halo,
                                                          "angular velocity at the middle of the step"};
inline constexpr Field<std::uint64_t> broken_bonds{"broken_bonds", "1",   scalar,
                                                   state,          owner, "bonds of the grain that broke"};
inline constexpr Field<double> bond_table{
    "bond_table", "1", scalar, state, owner, "index of the scene's table that the bond is of"};
inline constexpr Field<double> rest_length{"rest_length", "m",   scalar,
                                           state,         owner, "distance of the bonded centres at rest"};
inline constexpr Field<double> bond_radius{"bond_radius", "m",   scalar,
                                           state,         owner, "of the section of the bond"};
inline constexpr Field<double> shearing{
    "shearing", "m", vector, state, owner, "shear displacement of the bond, as the first grain sees it"};
inline constexpr Field<double> bending{
    "bending", "rad", vector, state, owner, "bending angle of the bond, as the first grain sees it"};

}  // namespace talus::field
