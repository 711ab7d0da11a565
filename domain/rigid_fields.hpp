#pragma once
#include "domain/fields.hpp"

namespace talus::field {

// Of scenes with rigid bodies made of particles (physics/rigid).

inline constexpr Field<double> place_in_body{
    "place_in_body", "m",   Shape::vector,
    state,           owner, "place from the centre of the rigid body, along its principal axes"};

}  // namespace talus::field
