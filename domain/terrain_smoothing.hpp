#pragma once
#include "domain/terrain.hpp"

namespace talus {

/// The grid with means over the points around in place of its values: weights fall linearly to zero at
/// `length` [m] along x, then along y. Points count in pairs on both sides, so that planes stay as they are,
/// at the rim and beside what is not known too; what is not known stays so. A length of one spacing or less
/// changes nothing.
TerrainGrid smoothed(TerrainGrid grid, double length);

}  // namespace talus
