#include <gtest/gtest.h>

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
            int layer = 4, faces = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const int k = static_cast<int>(sample.fluid.data(field::position, axis)[a] / spacing),
                          depth = std::min(k, 7 - k);
                layer = std::min(layer, depth);
                faces += depth == 0 ? 1 : 0;
            }
            const double found = sample.fluid.data(field::density)[a];
            if (density < rest) {
                EXPECT_EQ(found, layer == 0 ? rest : layer > 1 ? density : found);
            } else {
                EXPECT_EQ(found, faces < 2 ? density : faces == 3 ? rest : found);  // corners: a third full
            }
        }
    }
}

}  // namespace
}  // namespace talus::test
