#include "physics/dem/laws/damping.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace talus::dem {

namespace {

/// -ln e / sqrt(ln^2 e + pi^2): damping ratio of the linear oscillator whose half swing keeps e of its speed.
double damping_ratio(double restitution) {
    const double log_e = std::log(restitution);
    return -log_e / std::sqrt(log_e * log_e + std::numbers::pi * std::numbers::pi);
}

/// Restitution of the linear spring and dashpot of damping ratio zeta without attraction.
double linear_restitution_cut(double zeta) {
    const double difference = 1 - zeta * zeta;
    if (difference == 0) return std::exp(-2.0);
    const double root = std::sqrt(std::abs(difference));
    if (zeta < 1) {
        const double angle = std::atan2(2 * zeta * root, 2 * zeta * zeta - 1);
        return std::exp(-zeta / root * angle);
    }
    return std::exp(-zeta / root * std::log((zeta + root) / (zeta - root)));
}

/// Restitution of x'' = -max(x^(3/2) + c x^(1/4) x', 0), x(0) = 0, x'(0) = 1.
double hertz_restitution_cut(double c) {
    constexpr double step = 1e-3;
    const auto force = [c](double x, double v) {
        const double a = std::sqrt(std::max(x, 0.0));
        return x * a + c * std::sqrt(a) * v;
    };
    double x = 0, v = 1;
    while (v > 0 || force(x, v) > 0) {
        const double v1 = v, a1 = -force(x, v1);
        const double v2 = v + step / 2 * a1, a2 = -force(x + step / 2 * v1, v2);
        const double v3 = v + step / 2 * a2, a3 = -force(x + step / 2 * v2, v3);
        const double v4 = v + step * a3, a4 = -force(x + step * v3, v4);
        x += step / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
        v += step / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
    return -v;
}

/// Where a falling function of the damping passes `wanted`.
double bisect(double (*restitution_of)(double), double wanted, double greatest) {
    double low = 0, high = greatest;
    for (int halving = 0; halving < 48; ++halving) {
        const double middle = 0.5 * (low + high);
        (restitution_of(middle) > wanted ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

void check(double restitution, EndOfContact end) {
    if (!(restitution >= 0 && restitution <= 1))
        throw std::invalid_argument("a coefficient of restitution lies within [0, 1]");
    if (end == EndOfContact::cut_at_zero && restitution < least_restitution_cut)
        throw std::invalid_argument(
            "restitution below 0.01 asks for more damping than a force cut at zero gives");
}

}  // namespace

double linear_damping(double restitution, EndOfContact end) {
    check(restitution, end);
    if (restitution == 1) return 0;
    if (end == EndOfContact::cut_at_zero) return 2 * bisect(linear_restitution_cut, restitution, 10);
    return restitution == 0 ? 2 : 2 * damping_ratio(restitution);
}

double hertz_damping(double restitution, EndOfContact end) {
    check(restitution, end);
    if (restitution == 1) return 0;
    if (end == EndOfContact::cut_at_zero) return bisect(hertz_restitution_cut, restitution, 20);
    return restitution == 0 ? std::sqrt(5.0) : std::sqrt(5.0) * damping_ratio(restitution);
}

}  // namespace talus::dem
