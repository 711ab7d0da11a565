#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "domain/random.hpp"
#include "tests/support/mixture.hpp"

namespace talus::test {
namespace {

namespace of = coupling_field;
using coupling::Mollifier;
using coupling::VolumeFraction;
using Shape = coupling::Spreading::Shape;

Box box_of(std::array<double, 3> upper, std::array<Boundary, 3> boundary) {
    Box box;
    box.upper = upper;
    box.boundary = boundary;
    return box;
}
constexpr std::array<Boundary, 3> open{},
    periodic{Boundary::periodic, Boundary::periodic, Boundary::periodic},
    slab{Boundary::open, Boundary::periodic, Boundary::periodic};

/// Grains on a lattice that fills the box up to its walls.
std::vector<PlacedSphere> lattice(const Box& box, double spacing, double radius) {
    std::vector<PlacedSphere> grains;
    for (double z = 0.5 * spacing; z < box.upper[2]; z += spacing)
        for (double y = 0.5 * spacing; y < box.upper[1]; y += spacing)
            for (double x = 0.5 * spacing; x < box.upper[0]; x += spacing)
                grains.push_back({{x, y, z}, radius});
    return grains;
}

std::vector<PlacedSphere> random_grains(std::size_t count, const Box& box) {
    const RandomStream random{.seed = 3};
    std::vector<PlacedSphere> grains;
    for (std::size_t k = 0; k < count; ++k)
        grains.push_back({{box.upper[0] * random.uniform(k, 0), box.upper[1] * random.uniform(k, 1),
                           box.upper[2] * random.uniform(k, 2)},
                          0.05 + 0.1 * random.uniform(k, 3)});
    return grains;
}

// Constants: 1/integral of exp(1/(r^2 - 1)), by quadrature of 30 digits.
TEST(VolumeFraction, ConstantsOfTheMollifier) {
    EXPECT_NEAR(Mollifier<1>::constant, 2.25228362104358101, 1e-15);
    EXPECT_NEAR(Mollifier<2>::constant, 2.14356577579223660, 1e-15);
    EXPECT_NEAR(Mollifier<3>::constant, 2.26711673960832646, 1e-15);
    for (const double radius : {0.5, 2.0}) {  // the integral over the ball, by the rule of rectangles
        double mollified = 0, wendland = 0;
        constexpr int steps = 20000;
        for (int k = 0; k < steps; ++k) {
            const double r = (k + 0.5) * radius / steps,
                         shell = 4 * std::numbers::pi * r * r * radius / steps;
            mollified += shell * Mollifier<3>(radius)(r * r);
            wendland += shell * coupling::WendlandWeight(radius)(r * r);
        }
        EXPECT_NEAR(mollified, 1, 1e-8);
        EXPECT_NEAR(wendland, 1, 1e-8);
    }
}

// On any particles, near walls and at free surfaces, the fraction's integral is the volume of the grains.
TEST(VolumeFraction, NormalisedKeepsVolume) {
    for (const double jitter : {0.0, 0.2, 0.4})
        for (const auto& boundary : {open, periodic}) {
            const Box box = box_of({4, 4, 3}, boundary);
            MixtureSample sample({.box = box, .spacing = 0.4, .jitter = jitter, .spreading = {.radius = 1.0}},
                                 random_grains(300, box));
            sample.spreading.full = 0.05;  // no grain counts as partly dry
            sample.find_fractions();
            EXPECT_NEAR(sample.integral(of::solid_fraction) / sample.grain_volume(), 1, 1e-13);
        }
}

/// Share of the volume that the raw kernel loses, grains and fluid on lattices of that spacing.
double lost_by_raw_kernel(const std::array<Boundary, 3>& boundary, double spacing) {
    const Box box = box_of({4, 2, 2}, boundary);
    MixtureSample sample(
        {.box = box, .spacing = spacing, .spreading = {.shape = Shape::mollifier, .radius = 1.0}},
        lattice(box, spacing, 0.05));
    sample.find_fractions(VolumeFraction::raw);
    return 1 - sample.integral(of::solid_fraction) / sample.grain_volume();
}

// What the raw kernel loses through the two open faces: R E|x|/L of the volume, E|x| = 0.276373 R the mean
// distance along an axis under the mollifier, in the limit of fine lattices, from two of them whose sums at a
// face err by their spacing squared. Without faces it loses nothing.
TEST(VolumeFraction, RawKernelLosesAtWallsWhatReachesBeyond) {
    const double coarse = lost_by_raw_kernel(slab, 1.0 / 6), fine = lost_by_raw_kernel(slab, 1.0 / 8);
    EXPECT_NEAR((64 * fine - 36 * coarse) / 28, 0.276373 / 4, 2e-4);
    EXPECT_NEAR(lost_by_raw_kernel(periodic, 1.0 / 8), 0, 2e-4);
}

/// Relative rms errors of the fraction of a crowd in a periodic box, against the sum of the weights of all
/// grains at each particle, the limit of fine water.
struct FractionErrors {
    double normalised = 0, counted = 0;  ///< counted: each grain in the nearest particle of the lattice
};

FractionErrors errors_at(double spacing) {
    const Box box = box_of({4, 4, 4}, periodic);
    const std::vector<PlacedSphere> grains = random_grains(1200, box);
    MixtureSample sample({.box = box, .spacing = spacing, .spreading = {.radius = 1.2}}, grains);
    sample.find_fractions();
    const coupling::WendlandWeight weight(1.2);
    const auto ball = [](double radius) { return 4.0 / 3 * std::numbers::pi * std::pow(radius, 3); };
    double normalised = 0, counted = 0, mean = 0;
    for (std::size_t a = 0; a < sample.fluid.size(); ++a) {
        double exact = 0, nearest = 0;
        for (const PlacedSphere& grain : grains) {
            double r2 = 0;
            bool holds = true;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                double apart =
                    sample.fluid.data(field::position, static_cast<int>(axis))[a] - grain.place[axis];
                apart -= 4 * std::round(apart / 4);
                r2 += apart * apart;
                holds = holds && std::abs(apart) < 0.5 * spacing;
            }
            exact += ball(grain.radius) * weight(r2);
            if (holds) nearest += ball(grain.radius) / std::pow(spacing, 3);
        }
        normalised += std::pow(sample.fluid.data(of::solid_fraction)[a] - exact, 2);
        counted += std::pow(nearest - exact, 2);
        mean += exact;
    }
    const double count = static_cast<double>(sample.fluid.size());
    return {std::sqrt(normalised / count) / (mean / count), std::sqrt(counted / count) / (mean / count)};
}

// On water twice as fine the normalised kernel errs less, by the cube of the spacing and more (the rule of
// midpoints for a weight that is smooth but at its edge). What a particle counts errs more, as the square
// root of the number of particles for grains fewer than those: by 2.8.
TEST(VolumeFraction, FinerWaterHelpsTheKernelAndHarmsCounting) {
    const FractionErrors coarse = errors_at(0.5), fine = errors_at(0.25);
    EXPECT_LT(fine.normalised, coarse.normalised / 8);
    EXPECT_GT(fine.counted, 2 * coarse.counted);
    EXPECT_LT(fine.normalised, 0.01);
    EXPECT_GT(fine.counted, 1);
}

// Grains on a lattice up to the walls: with images the fraction is even to 1 %, without it is short by a
// quarter.
TEST(VolumeFraction, ImagesKeepItEvenAtWalls) {
    constexpr double spacing = 0.25, radius = 0.1;
    const Box box = box_of({2.5, 2.5, 2.5}, open);
    const double bulk = 4.0 / 3 * std::numbers::pi * std::pow(radius / spacing, 3);
    for (const bool mirrored : {true, false}) {
        coupling::Spreading spreading{.radius = 1.0};
        if (mirrored)
            for (const auto& [point, normal] :
                 std::initializer_list<std::pair<dem::Vector3<>, dem::Vector3<>>>{{{0, 0, 0}, {1, 0, 0}},
                                                                                  {{0, 0, 0}, {0, 1, 0}},
                                                                                  {{0, 0, 0}, {0, 0, 1}},
                                                                                  {{2.5, 0, 0}, {-1, 0, 0}},
                                                                                  {{0, 2.5, 0}, {0, -1, 0}},
                                                                                  {{0, 0, 2.5}, {0, 0, -1}}})
                spreading.planes.push_back({point, normal});
        MixtureSample sample({.box = box, .spacing = 0.25, .spreading = spreading},
                             lattice(box, spacing, radius));
        sample.find_fractions();
        double worst = 0;
        for (const double alpha : sample.fluid.own(of::solid_fraction))
            worst = std::max(worst, std::abs(alpha / bulk - 1));
        if (mirrored) {
            EXPECT_LT(worst, 0.01);
        } else
            EXPECT_GT(worst, 0.2);
    }
}

// Grains on a lattice that stands out of the fluid: at its surface it has about the fraction of the bulk. Of
// a continuum, by quadrature, 1.162 of it at most and a layer of 0.072 R too many.
TEST(VolumeFraction, BedThatStandsOutOfTheFluid) {
    constexpr double spacing = 0.125, radius = 0.05, depth = 2.5;
    const Box box = box_of({2.5, 2.5, depth}, {Boundary::periodic, Boundary::periodic, Boundary::open}),
              bed = box_of({2.5, 2.5, depth + 1.5}, open);
    const double bulk = 4.0 / 3 * std::numbers::pi * std::pow(radius / spacing, 3);
    coupling::Spreading spreading{.radius = 1.0};
    spreading.planes.push_back({{0, 0, 0}, {0, 0, 1}});
    MixtureSample sample({.box = box, .spacing = 0.25, .spreading = spreading},
                         lattice(bed, spacing, radius));
    sample.find_fractions();
    double greatest = 0;
    for (const double alpha : sample.fluid.own(of::solid_fraction)) greatest = std::max(greatest, alpha);
    EXPECT_NEAR(greatest / bulk, 1.162, 0.03);  // at places a quarter of R apart
    EXPECT_NEAR(sample.integral(of::solid_fraction) / (bulk * 2.5 * 2.5), depth + 0.072, 0.02);
}

// One grain that crosses the fluid in steps of a fiftieth of its spacing: no fraction changes by more than
// the step times the steepest slope of the weight allows, 21/(2 pi R^4) 20/4 (3/4)^3, and a tenth for the
// sums; the whole volume stays.
TEST(VolumeFraction, SmoothWhileAGrainMoves) {
    constexpr double spacing = 0.5, radius = 0.2;
    const Box box = box_of({4, 4, 4}, open);
    constexpr double reach = 1.5 * spacing;
    const double steepest = 21 / (2 * std::numbers::pi) * std::pow(reach, -4) * 5 * 27 / 64,
                 most = 1.1 * 0.02 * spacing * 4.0 / 3 * std::numbers::pi * std::pow(radius, 3) * steepest;
    std::vector<double> before;
    for (int step = 0; step < 60; ++step) {
        MixtureSample sample({.box = box, .spacing = spacing, .spreading = {.radius = reach}},
                             {{{1.9 + 0.02 * spacing * step, 2.1, 1.95}, radius}});
        sample.find_fractions();
        EXPECT_NEAR(sample.integral(of::solid_fraction) / sample.grain_volume(), 1, 1e-13);
        const auto now = sample.fluid.own(of::solid_fraction);
        for (std::size_t a = 0; a < before.size(); ++a) EXPECT_LT(std::abs(now[a] - before[a]), most);
        before.assign(now.begin(), now.end());
    }
}

// Nowhere more than the lattice that the grains sit on holds, to the error of quadrature.
TEST(VolumeFraction, StaysBelowThatOfThePacking) {
    const Box box = box_of({3, 3, 3}, periodic);
    const double packing = 0.6, radius = 0.25 * std::cbrt(packing * 3 / (4 * std::numbers::pi));
    MixtureSample sample({.box = box, .spacing = 0.3, .jitter = 0.2, .spreading = {.radius = 1.0}},
                         lattice(box, 0.25, radius));
    sample.find_fractions();
    for (const double alpha : sample.fluid.own(of::solid_fraction)) EXPECT_LT(alpha, 1.15 * packing);
}

// A grain that leaves the fluid counts less and less, without a step.
TEST(VolumeFraction, GrainsThatLeaveTheFluid) {
    const Box box = box_of({4, 4, 4}, open);
    double last = 1;
    for (const double height : {3.0, 3.9, 4.2, 4.5, 4.8, 4.95, 5.2}) {
        MixtureSample sample({.box = box, .spacing = 0.25, .spreading = {.radius = 1.0}},
                             {{{2, 2, height}, 0.1}});
        sample.find_fractions();
        const double counted = sample.integral(of::solid_fraction) / sample.grain_volume();
        EXPECT_LE(counted, last + 1e-13);
        if (height < 3.5) {
            EXPECT_NEAR(counted, 1, 1e-13);
        }
        if (height > 5) {
            EXPECT_EQ(counted, 0);
        }
        last = counted;
    }
}

}  // namespace
}  // namespace talus::test
