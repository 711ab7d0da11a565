#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "physics/soil/hencky.hpp"
#include "physics/solid/stress_update.hpp"

namespace talus::soil {
namespace {

const Elasticity elastic{.youngs_modulus = 8e7, .poisson_ratio = 0.3};

Eigen::Matrix3d turn(double angle, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

/// Elastic simple shear to `shear`; what the stress is on the way.
template <class Visit>
void shear_to(double shear, int steps, const Material& material, Visit&& visit) {
    Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
    f(0, 1) = shear / steps;
    Tensor stress{};
    History history;
    for (int k = 1; k <= steps; ++k) {
        stress = hencky_stress(material.elasticity, stress, f);
        ASSERT_TRUE(relax(material, 1, 1.0 / steps, stress, history));
        visit(shear * k / steps, stress);
    }
}

// tau = 4 G asinh(g/2)/sqrt(4 + g^2): ln of the left stretch, whose larger value is asinh(g/2), turned by its
// axes. It rises to 1.325 G at g = 3.02 and never changes sign. Jaumann's rate gives G sin(g): 0.26 where
// this is 1.30 at g = 2.88, and negative beyond pi.
TEST(SoilHencky, SimpleShearFollowsItsClosedForm) {
    const double shear_modulus = elastic.shear_modulus();
    std::array<double, 3> jaumann{};
    const std::array<double, 4> gradient{0, 1, 0, 0};
    double greatest = 0;
    Material material;
    material.elasticity = elastic;
    shear_to(8, 800, material, [&](double g, const Tensor& stress) {
        const double exact = 4 * shear_modulus * std::asinh(g / 2) / std::sqrt(4 + g * g);
        EXPECT_NEAR(stress[3], exact, 1e-10 * shear_modulus);
        EXPECT_NEAR(stress[0], -stress[1], 1e-10 * shear_modulus);
        jaumann = advanced_stress<2>(jaumann, gradient, shear_modulus, 0.01);
        EXPECT_NEAR(jaumann[2], shear_modulus * std::sin(g), 1e-4 * shear_modulus);
        greatest = std::max(greatest, stress[3]);
    });
    EXPECT_NEAR(greatest, 1.3255 * shear_modulus, 1e-4 * shear_modulus);
    EXPECT_LT(jaumann[0] + jaumann[1], 1e-6 * shear_modulus);
}

// Once soil flows the elastic strain stays small: the normal stress is tau^2/G, a share tau/G of the shear.
TEST(SoilHencky, FlowBoundsTheNormalStressOfLargeShear) {
    const double limit = 1e5;
    Material clay;
    clay.elasticity = elastic;
    clay.overstress = {.fluidity = 1e4, .exponent = 1, .reference = limit};
    clay.surface = VonMises{.yield_stress = limit};
    const double tau = limit / std::sqrt(3.0);
    shear_to(8, 80000, clay, [&](double g, const Tensor& stress) {
        if (g < 0.1) return;
        EXPECT_NEAR(stress[3], tau, 0.01 * tau);
        EXPECT_LT(std::abs(stress[0]), 1.05 * tau * tau / elastic.shear_modulus());
    });
}

TEST(SoilHencky, RotationTurnsTheStressAndDoesNoMore) {
    Tensor stress{-1e5, -2e5, -4e5, 5e4, 3e4, 1e4};
    const double before = mises_stress(stress), mean = trace(stress);
    const Eigen::Matrix3d step = turn(2 * std::numbers::pi / 100, {1, 2, -1});
    const Tensor start = stress;
    for (int k = 0; k < 50; ++k) stress = hencky_stress(elastic, stress, step);
    EXPECT_NEAR(mises_stress(stress), before, 1e-9 * before);
    EXPECT_NEAR(trace(stress), mean, -1e-9 * mean);
    for (int k = 50; k < 100; ++k) stress = hencky_stress(elastic, stress, step);
    for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(stress[k], start[k], 1e-9 * before);
}

TEST(SoilHencky, StressDoesNotDependOnThePath) {
    // A closed path of stretch, shear and turn leaves nothing; Jaumann's rate would leave some.
    Eigen::Matrix3d stretch = Eigen::Vector3d(1.5, 0.8, 1).asDiagonal(), shear = Eigen::Matrix3d::Identity();
    shear(0, 1) = 0.7;
    const Eigen::Matrix3d spin = turn(0.9, {0, 0, 1});
    const Tensor start{-1e5, 2e5, -3e5, 4e4, 0, 0};
    Tensor stress = start;
    const Eigen::Matrix3d back = (spin * shear * stretch).inverse();
    for (const Eigen::Matrix3d& f : {stretch, shear, spin, back}) stress = hencky_stress(elastic, stress, f);
    for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(stress[k], start[k], 1e-7 * 8e7 * 0.1);
}

TEST(SoilHencky, InThePlaneAndInSpaceAreTheSame) {
    Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
    f.topLeftCorner<2, 2>() << 1.1, 0.3, -0.2, 0.9;
    const Tensor plane{-1e5, -2e5, -4e5, 5e4, 0, 0};
    const Tensor expected = hencky_stress(elastic, plane, f);
    const Eigen::Matrix3d exchange{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};  // x y z become y z x
    const Tensor turned{plane[2], plane[0], plane[1], 0, 0, plane[3]};
    const Tensor found = hencky_stress(elastic, turned, exchange * f * exchange.transpose());
    EXPECT_NEAR(found[1], expected[0], 1e-2);
    EXPECT_NEAR(found[2], expected[1], 1e-2);
    EXPECT_NEAR(found[5], expected[3], 1e-2);
}

}  // namespace
}  // namespace talus::soil
