#pragma once
#include "domain/fields.hpp"

namespace talus::field {

// What a cell of the results' raster keeps of the flow that has passed it.

inline constexpr Field<float> greatest_depth{
    "greatest_depth", "m", scalar, state, owner, "greatest depth of the flow so far"};
inline constexpr Field<float> greatest_speed{
    "greatest_speed", "m s-1", scalar, state, owner, "greatest speed of the flow so far"};
inline constexpr Field<float> arrival_time{"arrival_time", "s",   scalar,
                                           state,          owner, "when the flow first came"};

}  // namespace talus::field
