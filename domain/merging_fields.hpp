#pragma once
#include "domain/fields.hpp"

namespace talus::field {

// Fields of depth-integrated flows whose columns merge, besides those of depth_fields.hpp.

inline constexpr Field<std::uint64_t> known_id{"known_id", "1", scalar, work, halo, "the id, of copies too"};
inline constexpr Field<std::uint64_t> nearest_column{
    "nearest_column", "1", scalar, work, halo, "id of the column to merge with, its own if there is none"};

}  // namespace talus::field
