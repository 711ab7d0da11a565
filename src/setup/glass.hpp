#pragma once
#include <cstdint>

#include "src/setup/packing.hpp"

namespace talus {

/// A disordered packing of even density, for 2D and 3D: points strewn at random in a periodic cell and
/// relaxed, damped, under a soft repulsion until they rest. Depends on the seed alone.
UnitCell glass_cell(int dimension, std::uint64_t seed);

}  // namespace talus
