#include "physics/sph/kernels.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <string>

namespace talus {
namespace {

constexpr double h = 0.7;  // [m]

template <int D>
double sphere(double r) {  // surface of the ball [m^(D-1)]
    return D == 1 ? 2 : D == 2 ? 2 * std::numbers::pi * r : 4 * std::numbers::pi * r * r;
}

/// Simpson's rule over the support, up to just within its end, where the Gaussian's slope jumps; the knot of
/// the cubic spline at r = h lies between two pairs of its steps.
template <class Kernel>
double integral(const Kernel& kernel, const std::function<double(double)>& of) {
    constexpr int steps = 4000;
    const double width = kernel.support() * h * (1 - 1e-13) / steps;
    double sum = 0;
    for (int k = 0; k <= steps; ++k) sum += (k == 0 || k == steps ? 1 : k % 2 == 1 ? 4 : 2) * of(k * width);
    return sum * width / 3;
}

/// W integrates to 1 and (1/r) dW/dr times r is its derivative. Tolerances: of Simpson's rule (1e-13 for
/// these functions) and of exp_minus() as its comment says; of central differences of fourth order, e^4/30 of
/// the fifth derivative, 1e-10 of W(0)/h at most with e = 1e-3 h.
template <int D, class Kernel>
void expect_kernel(const Kernel& kernel, const std::string& name) {
    SCOPED_TRACE(testing::Message() << name << " in " << D << "D, support " << kernel.support());
    const auto W = [&](double r) { return kernel.value(r * r, 1 / h); };
    const auto slope = [&](double r) { return r * kernel.factor(r * r, 1 / h); };
    EXPECT_NEAR(integral(kernel, [&](double r) { return sphere<D>(r) * W(r); }), 1, 2e-11);
    // By parts, of a kernel that ends at zero: the first moment of its gradient.
    EXPECT_NEAR(integral(kernel, [&](double r) { return -sphere<D>(r) * r * slope(r); }), D, 1e-10);
    const double e = 1e-3 * h, end = kernel.support() * h;
    for (double r = 0.0137 * h; r < end - 2 * e; r += 0.0271 * h) {
        if (std::abs(r - h) < 2 * e) continue;  // the third derivative of the cubic spline jumps there
        const double difference = (W(r - 2 * e) - 8 * W(r - e) + 8 * W(r + e) - W(r + 2 * e)) / (12 * e);
        EXPECT_NEAR(slope(r), difference, 2e-10 * W(0) / h) << "r = " << r / h << " h";
    }
    for (const double r : {1.0000001 * end, 1.5 * end}) {
        EXPECT_NEAR(W(r), 0, 1e-14 * W(0));
        EXPECT_EQ(slope(r), 0);
    }
    for (const double r : {0.0, 0.3 * h, h, 1.7 * h}) {  // lanes compute the same
        EXPECT_TRUE(all_of(kernel.value(Lanes(r * r), Lanes(1 / h)) == Lanes(W(r))));
        EXPECT_TRUE(all_of(kernel.factor(Lanes(r * r), Lanes(1 / h)) == Lanes(kernel.factor(r * r, 1 / h))));
    }
}

template <int D>
void expect_kernels() {
    for (const double cutoff : {2.0, 2.5, 2.78, 3.0, 4.0})
        expect_kernel<D>(sph::Gaussian<D>(cutoff), "Gaussian");
    expect_kernel<D>(sph::CubicSpline<D>(), "cubic spline");
    expect_kernel<D>(sph::WendlandC2<D>(), "Wendland C2");
    expect_kernel<D>(sph::WendlandC4<D>(), "Wendland C4");
    expect_kernel<D>(sph::WendlandC6<D>(), "Wendland C6");
}

TEST(Kernels, IntegrateToOneAndHaveTheirSlope) {
    expect_kernels<1>();
    expect_kernels<2>();
    expect_kernels<3>();
}

}  // namespace
}  // namespace talus
