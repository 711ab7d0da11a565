#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "domain/coupling_fields.hpp"
#include "physics/coupling/averaging.hpp"
#include "tests/support/mixture.hpp"
#include "tests/support/root_of.hpp"
#include "tests/support/shared_cases.hpp"
#include "tests/support/stability_row.hpp"

/// Where the volume of grains, averaged over too little, fills more than all of the space.
namespace talus::test {
namespace {

constexpr double diameter = 1e-3, filled = 0.64, beads = 4;  // beads in a cell of the lattice
const double volume = std::numbers::pi / 6 * diameter * diameter * diameter,
             cell = std::cbrt(beads * volume / filled);
constexpr std::array<std::array<double, 3>, 4> of_cell{
    {{0, 0, 0}, {0.5, 0.5, 0}, {0.5, 0, 0.5}, {0, 0.5, 0.5}}};

/// The sum over a face-centred lattice of V w(r) at the place of one of its grains.
double fraction_at_a_grain(double radius) {
    const coupling::WendlandWeight weight(radius);
    const int reach = static_cast<int>(radius / cell) + 2;
    double sum = 0;
    for (int i = -reach; i <= reach; ++i)
        for (int j = -reach; j <= reach; ++j)
            for (int k = -reach; k <= reach; ++k)
                for (const auto& at : of_cell) {
                    const double x = i + at[0], y = j + at[1], z = k + at[2];
                    sum += volume * weight(cell * cell * (x * x + y * y + z * z));
                }
    return sum;
}

/// The greatest solid fraction on water ten points to a cell, one of them at each grain.
double greatest_fraction(double radius) {
    constexpr int cells = 3, points = 10;
    Box box;
    box.dimension = 3;
    const double spacing = cell / points;
    for (std::size_t a = 0; a < 3; ++a) {
        box.lower[a] = -spacing / 2;
        box.upper[a] = cells * cell - spacing / 2;
        box.boundary[a] = Boundary::periodic;
    }
    std::vector<PlacedSphere> spheres;
    for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j)
            for (int k = 0; k < cells; ++k)
                for (const auto& at : of_cell)
                    spheres.push_back(
                        {{cell * (i + at[0]), cell * (j + at[1]), cell * (k + at[2])}, diameter / 2});
    MixtureSample sample({.box = box, .spacing = spacing, .spreading = {.radius = radius}}, spheres);
    sample.find_fractions();
    double greatest = 0;
    for (const double fraction : sample.fluid.own(coupling_field::solid_fraction))
        greatest = std::max(greatest, fraction);
    return sample.comm.all_max(greatest);
}

// Beads that fill 0.64 of the space fill more than all of it where they are, if they are averaged over less
// than the radius at which the sum over their lattice is 1: 1.21 diameters. Water's points are a tenth of a
// cell apart, which errs by less than 2 % at the threshold.
TEST(SolidFraction, IsAboveOneWhereGrainsAreAveragedOverTooLittle) {
    const double threshold =
        root_of([](double radius) { return 1 - fraction_at_a_grain(radius); }, diameter, 2 * diameter);
    for (const double share : {0.8, 0.95, 1.05, 1.25, 2.0}) {
        const double radius = share * threshold, found = greatest_fraction(radius);
        EXPECT_EQ(found<1, share> 1) << share << ": " << found;
        EXPECT_NEAR(found / fraction_at_a_grain(radius), 1, 0.02) << share;
        if (is_root())
            print({"solid fraction", "face-centred beads, 0.64", "averaging length/diameter",
                   radius / diameter, threshold / diameter, "greatest solid fraction", found, found < 1});
    }
}

}  // namespace
}  // namespace talus::test
