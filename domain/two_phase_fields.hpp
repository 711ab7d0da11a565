#pragma once
#include "domain/fields.hpp"

namespace talus::field {

// Fields of depth-integrated flows of solid and water, besides those of depth_fields.hpp.

inline constexpr Field<double> is_water{"is_water", "1",  scalar,
                                        state,      halo, "1 for a column of water, 0 for one of solid"};
inline constexpr Field<double> other_height{
    "other_height", "m", scalar, state, halo, "height of the other phase where a column is"};
inline constexpr Field<double> other_cover{
    "other_cover",
    "1",
    scalar,
    work,
    halo,
    "kernel sum of the areas of the other phase's columns around: 1 within it, less at its edge"};
inline constexpr Field<double> lateral_gravity{
    "lateral_gravity", "m s-2", scalar, work, halo, "gravity that drives columns apart in plan"};
inline constexpr Field<double> relative_velocity{"relative_velocity",
                                                 "m s-1",
                                                 vector,
                                                 work,
                                                 halo,
                                                 "mean velocity of the water around less that of the solid"};
inline constexpr Field<double> exchange{
    "exchange", "kg m-4", scalar, work, halo, "momentum that drag moves from phase to phase in a step"};

inline constexpr Field<double> released_water{
    "released_water",
    "m2",
    scalar,
    work,
    halo,
    "of columns of solid: water of the ground taken up, over the sum of water around"};

}  // namespace talus::field
