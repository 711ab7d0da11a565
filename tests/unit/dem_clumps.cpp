#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "physics/dem/clumps/clump_shape.hpp"
#include "physics/dem/clumps/rotation.hpp"

/// Rigid clumps of spheres: their mass and moments, and how they turn when nothing touches them.
namespace talus::dem {
namespace {

constexpr double pi = std::numbers::pi;

TEST(ClumpShapes, SeparateSpheresAreExact) {
    // Two spheres of radius r that touch: I along 2 (2/5) m r^2, across that and 2 m r^2 more.
    const double r = 0.5, m = 4.0 / 3 * pi * r * r * r;
    const std::vector<Vector3<>> centres{{3, 1 - r, 2}, {3, 1 + r, 2}};
    const ClumpShape shape = clump_shape(centres, std::vector<double>{r, r});
    EXPECT_NEAR(shape.volume, 2 * m, 1e-14);
    EXPECT_NEAR(shape.inertia.x, 0.8 * m * r * r, 1e-14);
    EXPECT_NEAR(shape.inertia.y, 2.8 * m * r * r, 1e-14);
    EXPECT_NEAR(shape.inertia.z, 2.8 * m * r * r, 1e-14);
    EXPECT_NEAR(shape.extent, 2 * r, 1e-14);
    EXPECT_NEAR(shape.bounding_radius, 2 * r, 1e-14);
    EXPECT_NEAR(std::abs(shape.centres[0].x), r, 1e-14) << "the axis of symmetry is the first";
}

// Two spheres of radius 1 whose centres are 1 apart share a lens of volume 5 pi/12; along their axis the
// union's second moment follows from that of a ball cut at z = 1/2. Midpoint lines across: error below 1e-4.
TEST(ClumpShapes, WhatSpheresShareCountsOnce) {
    const std::vector<Vector3<>> centres{{0, 0, 0}, {0, 1, 0}};
    const ClumpShape shape = clump_shape(centres, std::vector<double>{1, 1});
    EXPECT_NEAR(shape.volume, 2 * 4.0 / 3 * pi - 5 * pi / 12, 1e-4 * 7);
    // About the axis: 2 * integral over y in (-1, 1/2) of pi/2 (1 - y^2)^2.
    const auto primitive = [](double y) {
        return pi / 2 * (y - 2.0 / 3 * y * y * y + y * y * y * y * y / 5);
    };
    const double along = 2 * (primitive(0.5) - primitive(-1));
    EXPECT_NEAR(shape.inertia.x, along, 1e-4 * along);
    // Across, through the middle: half of that and 2 * integral of (y - 1/2)^2 pi (1 - y^2).
    const auto second = [](double y) {
        return pi * (y * y * y / 3 - y * y / 2 + y / 4 - y * y * y * y * y / 5 + y * y * y * y / 4 -
                     y * y * y / 12);
    };
    const double across = along / 2 + 2 * (second(0.5) - second(-1));
    EXPECT_NEAR(shape.inertia.y, across, 1e-4 * across);
    EXPECT_NEAR(shape.inertia.z, across, 1e-4 * across);
}

// Shares of the mass at the spheres' centres: of two spheres the lever rule; of others those of the volumes
// if these have the centre of mass already, as spheres do that are apart; else any that do.
TEST(ClumpShapes, MassLiesAtTheSpheresWithItsCentre) {
    const std::vector<Vector3<>> two{{0, 0, 0}, {0, 1, 0}},
        four{{0, 0, 0}, {1, 0, 0}, {0.2, 1.1, 0}, {0, 0.2, 0.9}};
    const ClumpShape pair = clump_shape(two, std::vector<double>{0.9, 0.4}, 128);
    const double lever = norm(pair.centres[1]) / norm(two[1] - two[0]);
    EXPECT_NEAR(pair.mass_shares[0], lever, 1e-12);
    EXPECT_NEAR(pair.mass_shares[1], 1 - lever, 1e-12);
    const std::vector<double> apart{0.4, 0.5, 0.3, 0.35}, overlapping{0.7, 0.8, 0.5, 0.6};
    for (const std::vector<double>& radii : {apart, overlapping}) {
        const ClumpShape shape = clump_shape(four, radii, 128);
        double sum = 0, volume = 0;
        Vector3<> centre;
        for (std::size_t k = 0; k < 4; ++k) {
            EXPECT_GT(shape.mass_shares[k], 0);
            sum += shape.mass_shares[k];
            centre += shape.mass_shares[k] * shape.centres[k];
            volume += std::pow(radii[k], 3);
        }
        EXPECT_NEAR(sum, 1, 1e-12);
        EXPECT_LT(norm(centre), 1e-12);
        for (std::size_t k = 0; k < 4 && radii == apart; ++k)
            EXPECT_NEAR(shape.mass_shares[k], std::pow(radii[k], 3) / volume, 1e-12);
    }
}

TEST(ClumpShapes, ADuplicateChangesNothing) {
    const std::vector<Vector3<>> once{{0, 0, 0}, {1, 0.5, 0}}, twice{{0, 0, 0}, {1, 0.5, 0}, {1, 0.5, 0}};
    const ClumpShape a = clump_shape(once, std::vector<double>{0.7, 0.6});
    const ClumpShape b = clump_shape(twice, std::vector<double>{0.7, 0.6, 0.6});
    EXPECT_DOUBLE_EQ(a.volume, b.volume);
    EXPECT_NEAR(a.inertia.z, b.inertia.z, 1e-12);
}

TEST(ClumpShapes, RefusesNoSpheresAndNoRadius) {
    EXPECT_THROW(clump_shape({}, {}), std::invalid_argument);
    const std::vector<Vector3<>> one{{0, 0, 0}};
    EXPECT_THROW(clump_shape(one, std::vector<double>{0}), std::invalid_argument);
}

struct Top {
    Quaternion orientation;
    double greatest_energy_error = 0;
};

Top turned(const Vector3<>& momentum, const Vector3<>& inertia, double time, int steps) {
    Top top;
    const auto energy = [&](const Quaternion& q) {
        return 0.5 * dot(momentum, angular_velocity(momentum, inertia, RotationMatrix(q)));
    };
    const double before = energy(top.orientation);
    for (int k = 0; k < steps; ++k) {
        top.orientation = turned_freely(top.orientation, momentum, inertia, time / steps);
        top.greatest_energy_error =
            std::max(top.greatest_energy_error, std::abs(energy(top.orientation) / before - 1));
    }
    return top;
}

// A symmetric top turns by |L| t/I_1 about L while it spins by L_3 t (1/I_3 - 1/I_1) about its own axis
// (L. D. Landau, E. M. Lifshitz, Mechanics, section 33): known at any time. Errors fall with the square of
// the step.
TEST(ClumpRotation, SymmetricTopPrecesses) {
    const Vector3<> inertia{2, 2, 0.7}, momentum{0.8, 0.3, 1.1};
    const double time = 7, length = norm(momentum), about = 0.5 * length * time / inertia.x,
                 spin = 0.5 * momentum.z * time * (1 / inertia.z - 1 / inertia.x);
    const Quaternion exact = Quaternion{std::cos(about), (std::sin(about) / length) * momentum} *
                             Quaternion{std::cos(spin), {0, 0, std::sin(spin)}};
    std::array<double, 2> error{};
    for (const int k : {0, 1}) {
        const Quaternion q = turned(momentum, inertia, time, k == 0 ? 200 : 400).orientation;
        const double cosine = exact.scalar * q.scalar + dot(exact.vector, q.vector);
        error[static_cast<std::size_t>(k)] = std::acos(std::min(1.0, std::abs(cosine)));
    }
    EXPECT_LT(error[1], 1e-3);
    EXPECT_NEAR(error[0] / error[1], 4, 0.2);
}

// About the middle axis rotation is unstable: the body tumbles for ever, and its energy stays bounded.
TEST(ClumpRotation, EnergyOfATumblingBodyDoesNotDrift) {
    const Vector3<> inertia{1, 2, 3}, momentum{0.01, 2, 0};
    EXPECT_LT(turned(momentum, inertia, 200, 4000).greatest_energy_error, 2e-3);
    const double ten_times_longer = turned(momentum, inertia, 2000, 40000).greatest_energy_error;
    EXPECT_LT(ten_times_longer, 2e-3);
}

}  // namespace
}  // namespace talus::dem
