#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "domain/boundary.hpp"

namespace talus {
namespace {

Box box_of(int dimension, Boundary kind) {
    Box box;
    box.dimension = dimension;
    box.lower = {-1, -1, -1};
    box.upper = {3, 3, 3};
    box.boundary = {kind, kind, kind};
    return box;
}

double moved(Boundary kind, double x) {
    ParticleSet particles("one", 1);
    particles.resize(1);
    particles.data(field::position)[0] = x;
    apply_boundaries(particles, box_of(1, kind));
    return particles.data(field::position)[0];
}

TEST(ApplyBoundaries, OpenAxesLeaveParticlesAlone) {
    EXPECT_EQ(moved(Boundary::open, -17), -17);
    EXPECT_EQ(moved(Boundary::open, 17), 17);
}

TEST(ApplyBoundaries, PeriodicAxesWrapAnyNumberOfLengths) {
    EXPECT_EQ(moved(Boundary::periodic, 0.5), 0.5);
    EXPECT_EQ(moved(Boundary::periodic, -1), -1);
    EXPECT_EQ(moved(Boundary::periodic, 3), -1);
    EXPECT_EQ(moved(Boundary::periodic, 3.5), -0.5);
    EXPECT_EQ(moved(Boundary::periodic, -1.5), 2.5);
    EXPECT_EQ(moved(Boundary::periodic, 3.5 + 40), -0.5);
    EXPECT_EQ(moved(Boundary::periodic, -1.5 - 400), 2.5);
}

TEST(ApplyBoundaries, PeriodicResultIsInsideWhateverTheRounding) {
    for (const double x :
         {std::nextafter(-1.0, -2.0), std::nextafter(3.0, 4.0), -1 - 1e-17, 1e17, -1e17, 1e300}) {
        const double back = moved(Boundary::periodic, x);
        EXPECT_GE(back, -1) << x;
        EXPECT_LT(back, 3) << x;
    }
}

TEST(ApplyBoundaries, ReflectingAxesMirrorAnyNumberOfTimes) {
    EXPECT_EQ(moved(Boundary::reflecting, 0.5), 0.5);
    EXPECT_EQ(moved(Boundary::reflecting, -1), -1);
    EXPECT_EQ(moved(Boundary::reflecting, 3), 3);
    EXPECT_EQ(moved(Boundary::reflecting, 3.5), 2.5);
    EXPECT_EQ(moved(Boundary::reflecting, -1.25), -0.75);
    EXPECT_EQ(moved(Boundary::reflecting, 3 + 4 + 0.5), -0.5);  // off both walls
    EXPECT_EQ(moved(Boundary::reflecting, -1 - 4 - 0.5), 2.5);
    EXPECT_EQ(moved(Boundary::reflecting, 3 + 8 + 0.5), 2.5);
    for (const double x : {1e17, -1e17, 1e300, std::nextafter(3.0, 4.0)}) {
        EXPECT_GE(moved(Boundary::reflecting, x), -1) << x;
        EXPECT_LE(moved(Boundary::reflecting, x), 3) << x;
    }
}

TEST(ApplyBoundaries, WhatIsNotFiniteStaysVisible) {
    for (const Boundary kind : {Boundary::open, Boundary::periodic, Boundary::reflecting})
        for (const double x : {std::nan(""), std::numeric_limits<double>::infinity()})
            EXPECT_FALSE(std::isfinite(moved(kind, x)));
}

/// A set with one field of each shape, all values 1.
ParticleSet ones(int dimension, double x) {
    ParticleSet particles("one", dimension);
    for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
             &field::velocity, &field::density, &field::deviatoric_stress, &field::velocity_gradient,
             &field::acceleration, &field::body, &field::flaw_threshold, &field::predicted_velocity})
        particles.add(*info);
    particles.resize(1);
    for (int axis = 0; axis < dimension; ++axis) particles.data(field::position, axis)[0] = x;
    const auto set = [&](const Field<double>& field) {
        for (int c = 0; c < component_count(field.shape, dimension); ++c) particles.data(field, c)[0] = 1;
    };
    set(field::velocity);
    set(field::density);
    set(field::deviatoric_stress);
    set(field::velocity_gradient);
    set(field::acceleration);
    set(field::predicted_velocity);
    particles.data(field::flaw_threshold)[0] = 1;
    particles.data(field::body)[0] = 1;
    return particles;
}

std::vector<double> values(const ParticleSet& particles, const Field<double>& field) {
    std::vector<double> result;
    for (int c = 0; c < component_count(field.shape, particles.dimension()); ++c)
        result.push_back(particles.data(field, c)[0]);
    return result;
}

using Values = std::vector<double>;

TEST(ApplyBoundaries, OneWallMirrorsTheStateOfAParticle3D) {
    Box box = box_of(3, Boundary::open);
    box.boundary[1] = Boundary::reflecting;
    ParticleSet particles = ones(3, 3.5);
    apply_boundaries(particles, box);
    EXPECT_EQ(values(particles, field::position), (Values{3.5, 2.5, 3.5}));
    EXPECT_EQ(values(particles, field::velocity), (Values{1, -1, 1}));
    EXPECT_EQ(values(particles, field::acceleration), (Values{1, -1, 1}));
    EXPECT_EQ(values(particles, field::density), (Values{1}));
    EXPECT_EQ(values(particles, field::deviatoric_stress), (Values{1, 1, 1, -1, 1, -1}));  // xy and yz
    EXPECT_EQ(values(particles, field::velocity_gradient), (Values{1, -1, 1, -1, 1, -1, 1, -1, 1}));
    EXPECT_EQ(values(particles, field::predicted_velocity), (Values{1, 1, 1})) << "work fields need no care";
    EXPECT_EQ(particles.data(field::flaw_threshold)[0], 1);
    EXPECT_EQ(particles.data(field::body)[0], 1);
}

TEST(ApplyBoundaries, TwoWallsMirrorTwice2D) {
    ParticleSet particles = ones(2, -1.5);
    apply_boundaries(particles, box_of(2, Boundary::reflecting));
    EXPECT_EQ(values(particles, field::position), (Values{-0.5, -0.5}));
    EXPECT_EQ(values(particles, field::velocity), (Values{-1, -1}));
    EXPECT_EQ(values(particles, field::deviatoric_stress), (Values{1, 1, 1}));
    EXPECT_EQ(values(particles, field::velocity_gradient), (Values{1, 1, 1, 1}));
}

TEST(ApplyBoundaries, TwoBouncesOffOppositeWallsKeepTheState) {
    ParticleSet particles = ones(1, 3 + 4 + 0.5);
    apply_boundaries(particles, box_of(1, Boundary::reflecting));
    EXPECT_EQ(values(particles, field::velocity), (Values{1}));
}

TEST(MirrorSign, IsThatOfAReflectedProduct) {
    // A tensor made of two vectors must mirror as they do.
    for (int dimension = 1; dimension <= 3; ++dimension)
        for (int bits = 0; bits < 1 << dimension; ++bits) {
            const std::array<bool, 3> flip{(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0};
            const auto vector = [&](int a) { return mirror_sign(Shape::vector, a, dimension, flip); };
            EXPECT_EQ(mirror_sign(Shape::scalar, 0, dimension, flip), 1);
            for (int a = 0; a < dimension; ++a) {
                EXPECT_EQ(vector(a), flip[static_cast<std::size_t>(a)] ? -1 : 1);
                for (int b = 0; b < dimension; ++b)
                    EXPECT_EQ(mirror_sign(Shape::tensor, a * dimension + b, dimension, flip),
                              vector(a) * vector(b));
            }
            for (int c = 0; c < component_count(Shape::symmetric_tensor, dimension); ++c) {
                const AxisPair axes = symmetric_axes(c, dimension);
                EXPECT_EQ(mirror_sign(Shape::symmetric_tensor, c, dimension, flip),
                          vector(axes.first) * vector(axes.second));
            }
        }
}

}  // namespace
}  // namespace talus
