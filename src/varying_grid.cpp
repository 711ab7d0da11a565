#include "src/varying_grid.hpp"

#include <algorithm>

namespace talus {

namespace {
constexpr double room_to_grow = 1.3;  // of the largest smoothing length in a step
}  // namespace

bool VaryingGrid::fit(const Box& box, double needed, bool varies) {
    double radius = needed;
    if (varies) {
        radius = CellGrid::ladder_radius(needed * room_to_grow);
        for (int axis = 0; axis < box.dimension; ++axis)
            if (box.boundary[static_cast<std::size_t>(axis)] != Boundary::open)
                radius = std::max(needed, std::min(radius, box.length(axis)));
    }
    if (grid_ && radius == radius_) return false;
    grid_ = std::make_unique<CellGrid>(box, radius, cells_per_radius_);
    radius_ = radius;
    return true;
}

}  // namespace talus
