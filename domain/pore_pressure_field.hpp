#pragma once
#include "domain/fields.hpp"

namespace talus::field {

inline constexpr Field<double> excess_pore_pressure{
    "excess_pore_pressure",
    "Pa",
    profile,
    state,
    owner,
    "excess pore pressure at equal distances over the depth of the flow, the first at the bed"};

}  // namespace talus::field
