#include "physics/gravity/softening.hpp"

#include <cmath>
#include <numbers>

#include "physics/sph/pass_support.hpp"

namespace talus::gravity {

namespace {

/// M(q)/q^3 = 4 pi times the integral of W(q t) t^2 over 0 < t < 1, by Simpson's rule.
template <class Kernel>
double mean_inside(const Kernel& kernel, double q) {
    constexpr int steps = 4000;
    double total = 0;
    for (int k = 0; k <= steps; ++k) {
        const double t = static_cast<double>(k) / steps;
        const double weight = k == 0 || k == steps ? 1 : k % 2 == 1 ? 4 : 2;
        total += weight * t * t * kernel.value(q * q * t * t, 1.0);
    }
    return 4 * std::numbers::pi * total / (3 * steps);
}

/// Coefficients of powers of z of the polynomial through values at z = cos(pi k/(N - 1)).
template <std::size_t N>
std::array<double, N> through_lobatto_nodes(const std::array<double, N>& values) {
    constexpr std::size_t n = N - 1;
    std::array<double, N> powers{}, chebyshev{1}, next{0, 1};  // T_m and T_(m+1) in powers of z
    for (std::size_t m = 0; m <= n; ++m) {
        double coefficient = 0;
        for (std::size_t k = 0; k <= n; ++k)
            coefficient += (k == 0 || k == n ? 0.5 : 1.0) * values[k] *
                           std::cos(std::numbers::pi * static_cast<double>(m * k) / n);
        coefficient *= (m == 0 || m == n ? 1.0 : 2.0) / n;
        for (std::size_t p = 0; p <= n; ++p) powers[p] += coefficient * chebyshev[p];
        std::array<double, N> following{};
        for (std::size_t p = 0; p <= n; ++p) following[p] = (p > 0 ? 2 * next[p - 1] : 0) - chebyshev[p];
        chebyshev = next;
        next = following;
    }
    return powers;
}

}  // namespace

Softening<double> softening_of(const sph::Settings& settings) {
    constexpr std::size_t N = Softening<double>::force_terms;
    Softening<double> result{};
    sph::with_kernel<3>(settings, [&](const auto& kernel) {
        const double s = kernel.support(), half = 0.5 * s;
        std::array<double, N> values;
        for (std::size_t k = 0; k < N; ++k)
            values[k] = mean_inside(
                kernel, half * (1 + std::cos(std::numbers::pi * static_cast<double>(k) / (N - 1))));
        const double scale = 1 / (s * s * s * values[0]);  // 1 but for the quadrature
        for (double& value : values) value *= scale;
        const std::array<double, N> force = through_lobatto_nodes(values);
        std::array<double, N + 2> potential{};  // of z: 1/s + (s/2)^2 times the integral from z to 1
        for (std::size_t p = 0; p < N; ++p) {
            potential[p + 1] -= half * half * force[p] / static_cast<double>(p + 1);
            potential[p + 2] -= half * half * force[p] / static_cast<double>(p + 2);
        }
        double at_end = 0;
        for (const double c : potential) at_end += c;
        potential[0] = 1 / s - at_end;
        result = {s, force, potential};
    });
    return result;
}

}  // namespace talus::gravity
