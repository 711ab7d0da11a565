#include "physics/solid/strength.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <vector>

#include "domain/random.hpp"
#include "physics/solid/fracture.hpp"

namespace talus {
namespace {

const VonMises von_mises{.yield_stress = 3.5e9, .melt_energy = 3.4e6};
const Lundborg lundborg{
    .cohesion = 90e6, .limit = 1.5e9, .friction_intact = 2, .friction_damaged = 0.8, .melt_energy = 3.4e6};

/// Stored components of random stresses, and the matrix they stand for.
struct RandomStress {
    int dimension;
    std::array<std::vector<double>, 6> values;

    RandomStress(int dimension_, std::size_t count, double scale) : dimension(dimension_) {
        const RandomStream stream{.seed = 11};
        const int components = component_count(Shape::symmetric_tensor, dimension);
        for (int c = 0; c < components; ++c)
            for (std::size_t i = 0; i < count; ++i)
                values[static_cast<std::size_t>(c)].push_back(
                    scale * (2 * stream.uniform(i, static_cast<std::uint32_t>(c)) - 1));
        if (dimension == 3)
            for (std::size_t i = 0; i < count; ++i) values[2][i] = -values[0][i] - values[1][i];
    }
    StressColumns<double> columns() {
        StressColumns<double> c{dimension, {}};
        for (std::size_t k = 0; k < 6; ++k) c.component[k] = values[k].data();
        return c;
    }
    Eigen::Matrix3d matrix(std::size_t i) const {
        Eigen::Matrix3d s = Eigen::Matrix3d::Zero();
        const int components = component_count(Shape::symmetric_tensor, dimension);
        for (int c = 0; c < components; ++c) {
            const AxisPair axes = symmetric_axes(c, dimension);
            s(axes.first, axes.second) = s(axes.second, axes.first) = values[static_cast<std::size_t>(c)][i];
        }
        if (dimension == 1) s(1, 1) = s(2, 2) = -s(0, 0) / 2;
        if (dimension == 2) s(2, 2) = -s(0, 0) - s(1, 1);
        return s;
    }
};

template <int dimension>
void compare_with_eigen() {
    constexpr std::size_t count = 2000;
    RandomStress stress(dimension, count, 1e9);
    for (std::size_t i = 0; i < count; ++i) {
        const Eigen::Matrix3d s = stress.matrix(i);
        ASSERT_NEAR(s.trace(), 0, 1);
        const Deviator d = deviator<dimension>(stress.columns(), i);
        EXPECT_NEAR(second_invariant(d) / (0.5 * s.squaredNorm()), 1, 1e-13);
        const double P = 0.3e9 * (static_cast<double>(i % 7) - 3);
        const Eigen::Matrix3d sigma = s - P * Eigen::Matrix3d::Identity();
        const double largest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sigma).eigenvalues()[2];
        EXPECT_NEAR(tensile_strain<dimension>(P, d, 5e10), std::max(largest / 5e10, 0.0), 1e-7 * 1e9 / 5e10);
    }
}

TEST(Stress, InvariantAndPrincipalStressAgreeWithEigenIn1D) { compare_with_eigen<1>(); }
TEST(Stress, InvariantAndPrincipalStressAgreeWithEigenIn2D) { compare_with_eigen<2>(); }
TEST(Stress, InvariantAndPrincipalStressAgreeWithEigenIn3D) { compare_with_eigen<3>(); }

TEST(Stress, LargestPrincipalOfDegenerateStates) {
    EXPECT_EQ(largest_principal({}), 0);
    EXPECT_NEAR(largest_principal({.xx = 2, .yy = -1, .zz = -1}), 2, 1e-12);
    EXPECT_NEAR(largest_principal({.xx = 1, .yy = 1, .zz = -2}), 1, 1e-7);
    EXPECT_NEAR(largest_principal({.yz = 3}), 3, 1e-12);
    EXPECT_NEAR(largest_principal({.xx = 2e-150, .yy = -1e-150, .zz = -1e-150}) * 1e150, 2, 1e-9);
    // Nearly degenerate, turned away from the axes.
    for (const double split : {1e-3, 1e-6, 1e-9, 1e-12}) {
        const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
        const Eigen::Vector3d values(1 + split, 1 - split, -2);
        const Eigen::Matrix3d s = turn * values.asDiagonal() * turn.transpose();
        EXPECT_NEAR(largest_principal({s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(0, 2), s(1, 2)}), 1 + split,
                    1e-7);
    }
}

TEST(VonMises, ComparesWithTheStressOfASimplePull) {
    const double Y = 3.5e9;
    // Uniaxial stress Y: S = diag(2, -1, -1) Y/3, sqrt(3 J2) = Y.
    const double sqrt_J2 = std::sqrt(second_invariant({.xx = 2 * Y / 3, .yy = -Y / 3, .zz = -Y / 3}));
    EXPECT_NEAR(limit_factor(von_mises, sqrt_J2, 1e9, 0, 0), 1, 1e-12);
    EXPECT_NEAR(limit_factor(von_mises, 2 * sqrt_J2, 1e9, 0, 0), 0.5, 1e-12);
    EXPECT_EQ(limit_factor(von_mises, 0.5 * sqrt_J2, 1e9, 0, 0), 1);
    EXPECT_NEAR(limit_factor(von_mises, sqrt_J2, 1e9, 0.25 * 3.4e6, 0), 0.75, 1e-12);
    EXPECT_NEAR(limit_factor(von_mises, sqrt_J2, 1e9, 0, 0.4), 0.6, 1e-12);
    EXPECT_EQ(limit_factor(von_mises, sqrt_J2, 1e9, 4e6, 0), 0) << "molten";
    EXPECT_EQ(limit_factor(von_mises, sqrt_J2, 1e9, 0, 1), 0) << "broken";
}

TEST(Lundborg, Limits) {
    EXPECT_DOUBLE_EQ(lundborg.shear_strength(0, 0, 0), 90e6);
    EXPECT_DOUBLE_EQ(lundborg.shear_strength(-1e9, 0, 0), 90e6) << "tension counts as no pressure";
    EXPECT_NEAR(lundborg.shear_strength(1e15, 0, 0), 1.5e9, 1e4);
    EXPECT_NEAR((lundborg.shear_strength(1, 0, 0) - 90e6), 2, 1e-6) << "slope mu_i at P = 0";
    EXPECT_NEAR(lundborg.shear_strength(1e9, 1.7e6, 0), 0.5 * lundborg.shear_strength(1e9, 0, 0), 1);
    // By hand at P = 0.5 GPa: 90 MPa + 1 GPa/(1 + 1/1.41).
    EXPECT_NEAR(lundborg.shear_strength(0.5e9, 0, 0), 90e6 + 1e9 / (1 + 1 / 1.41), 1);
}

TEST(Lundborg, DamageLeadsFromIntactToCoulomb) {
    EXPECT_DOUBLE_EQ(lundborg.shear_strength(1e8, 0, 1), 0.8e8);
    EXPECT_EQ(lundborg.shear_strength(-1e8, 0, 1), 0);
    EXPECT_DOUBLE_EQ(lundborg.shear_strength(1e11, 0, 1), lundborg.shear_strength(1e11, 0, 0))
        << "friction never exceeds the intact strength";
    // Jutzi's eq. 6 as printed, (D - 1) Y_i + D Y_d, would be negative at D = 0 and give Y_d/2 - Y_i/2 half
    // way.
    const double intact = lundborg.shear_strength(1e8, 0, 0), broken = lundborg.shear_strength(1e8, 0, 1);
    EXPECT_DOUBLE_EQ(lundborg.shear_strength(1e8, 0, 0.5), 0.5 * (intact + broken));
    for (double D = 0; D < 1; D += 0.1) EXPECT_LE(lundborg.shear_strength(1e8, 0, D), intact);
}

TEST(Lundborg, WithoutARangeItIsPureCohesion) {
    const Lundborg flat{.cohesion = 1e6, .limit = 1e6, .friction_intact = 1, .friction_damaged = 0.5};
    EXPECT_EQ(flat.shear_strength(0, 0, 0), 1e6);
    EXPECT_EQ(flat.shear_strength(1e9, 1e9, 0), 1e6) << "without a melt energy heat does not soften";
}

TEST(Strength, LimitsTheStressOfOneBodyInEveryDimension) {
    for (const int dimension : {1, 2, 3}) {
        constexpr std::size_t count = 200;
        RandomStress stress(dimension, count, 5e8);
        const RandomStress before = stress;
        const std::vector<double> P(count, 2e8), u(count, 1e5), D(count, 0.3);
        std::vector<std::uint8_t> body(count);
        for (std::size_t i = 0; i < count; ++i) body[i] = i % 2;
        limit_stress(lundborg, {P, u, D}, stress.columns(), body, 1);
        const double most = lundborg.shear_strength(2e8, 1e5, 0.3);
        int limited = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const Eigen::Matrix3d was = before.matrix(i), is = stress.matrix(i);
            if (body[i] != 1) {
                EXPECT_EQ(was, is);
                continue;
            }
            const double sqrt_J2 = std::sqrt(0.5 * was.squaredNorm());
            const Eigen::Matrix3d expected = was * std::min(1.0, most / sqrt_J2);
            EXPECT_LT((is - expected).norm(), 1e-6 * most);
            limited += sqrt_J2 > most;
        }
        EXPECT_GT(limited, 20);
        EXPECT_LT(limited, 100);
        // Again changes nothing beyond rounding; no limit changes nothing at all.
        const RandomStress once = stress;
        limit_stress(lundborg, {P, u, D}, stress.columns(), body, 1);
        for (std::size_t i = 0; i < count; ++i)
            EXPECT_LT((stress.matrix(i) - once.matrix(i)).norm(), 1e-14 * most);
        RandomStress free = before;
        limit_stress(NoStrengthLimit{}, {P, u, {}}, free.columns(), body, 1);
        for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(free.matrix(i), before.matrix(i));
    }
}

TEST(Strength, CrackedMatterBearsNoTensionAndNoShearButFriction) {
    const std::vector<double> whole(3, 0.0), D{0, 0.25, 1};
    const std::vector<double> u(3, 0.0);
    const std::vector<std::uint8_t> body(3, 0);
    const auto respond = [&](const Strength& strength, double P, std::span<const double> damage) {
        std::vector<double> pressure(3, P), xx(3, 2e6), xy(3, 5e6);
        std::vector<double> yy(3, -2e6);
        const StressColumns<double> stress{2, {xx.data(), yy.data(), xy.data()}};
        limit_stress(strength, {pressure, u, damage}, stress, body, 0);
        relieve_stress(strength, damage, pressure, stress, body, 0);
        std::vector<std::array<double, 2>> result;
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_DOUBLE_EQ(xx[i], 0.4 * xy[i]) << "scaled as a whole";
            EXPECT_DOUBLE_EQ(yy[i], -xx[i]);
            result.push_back({pressure[i], xy[i]});
        }
        return result;
    };
    for (const Strength& strength : {Strength{NoStrengthLimit{}}, Strength{von_mises}}) {
        for (std::size_t i = 0; i < 3; ++i) {
            const double left = 1 - D[i];
            EXPECT_DOUBLE_EQ(respond(strength, -1e7, D)[i][0], -1e7 * left);
            EXPECT_DOUBLE_EQ(respond(strength, -1e7, D)[i][1], 5e6 * left);
            EXPECT_EQ(respond(strength, 1e7, D)[i][0], 1e7) << "cracks bear pressure";
            EXPECT_DOUBLE_EQ(respond(strength, 1e7, D)[i][1], 5e6 * left);
            EXPECT_EQ(respond(strength, -1e7, whole)[i][1], 5e6);
        }
    }
    // Friction: the strength falls, 90 MPa intact, mu_d P or nothing when broken.
    EXPECT_EQ(respond(lundborg, -1e7, D)[1], (std::array{-0.75e7, 5e6}));
    EXPECT_EQ(respond(lundborg, -1e7, D)[2][1], 0);
    EXPECT_EQ(respond(lundborg, 1e7, D)[2][1], 5e6) << "0.8e7 is more than sqrt(J2)";
    EXPECT_NEAR(respond(lundborg, 1e6, D)[2][1] * std::sqrt(1 + 0.16), 0.8e6, 1e-6);
}

}  // namespace
}  // namespace talus
