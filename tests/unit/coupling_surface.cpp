#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <utility>

#include "physics/coupling/free_surface.hpp"
#include "tests/support/mixture.hpp"

namespace talus::test {
namespace {

namespace of = coupling_field;

// Water on a lattice of a unit cube, open all around, of which a tenth too little density is tension: only
// the outer layer is relieved; and of too much pressure, nothing but a drop.
TEST(FreeSurface, RelievesTensionAtTheSurfaceAndDrops) {
    constexpr double rest = 1000, spacing = 0.125, radius = 3.464 * spacing;
    Box box;
    box.upper = {1, 1, 1};
    for (const double density : {0.9 * rest, 1.1 * rest}) {
        MixtureSample sample({.box = box, .spacing = spacing, .spreading = {.radius = radius}}, {});
        sample.fluid.add(field::density);
        for (std::size_t a = 0; a < sample.fluid.size(); ++a) sample.fluid.data(field::density)[a] = density;
        sample.refresh_fluid({&field::position, &of::quadrature_volume});
        coupling::relieve_free_surface(sample.fluid, sample.fluid_cells.table(), radius, rest);
        for (std::size_t a = 0; a < sample.fluid.size(); ++a) {
            std::array<int, 3> depth{};  // in layers below the faces, the least first
            for (int axis = 0; axis < 3; ++axis) {
                const int k = static_cast<int>(sample.fluid.data(field::position, axis)[a] / spacing);
                depth[static_cast<std::size_t>(axis)] = std::min(k, 7 - k);
            }
            std::ranges::sort(depth);
            const double found = sample.fluid.data(field::density)[a];
            if (density < rest) {  // of the second layer, those that are far from other faces
                if (depth[0] == 0) {
                    EXPECT_EQ(found, rest);
                }
                if (depth[0] > 1 || (depth[0] == 1 && depth[1] == 3)) {
                    EXPECT_EQ(found, density);
                }
            } else {  // corners are a third full, edges half
                if (depth[1] > 0) {
                    EXPECT_EQ(found, density);
                }
                if (depth[2] == 0) {
                    EXPECT_EQ(found, rest);
                }
            }
        }
    }
}

}  // namespace
}  // namespace talus::test
