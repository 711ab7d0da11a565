#include "tests/support/sphere_release.hpp"

#include <cmath>
#include <numbers>

namespace talus::test {

namespace {

struct Coefficients {
    double a, b;
};

Coefficients coefficients(const SphereRelease& s) {
    const double heavy = 2 * s.density_ratio + 1;
    return {36 * s.viscosity / (s.diameter * s.diameter * heavy),
            18 * std::sqrt(s.viscosity) / (s.diameter * heavy)};
}

/// exp(x^2) erfc(x) for x >= 0, by its continued fraction where the factors would overflow.
double scaled_erfc(double x) {
    if (x < 5) return std::exp(x * x) * std::erfc(x);
    double fraction = x;
    for (int k = 40; k > 0; --k) fraction = x + 0.5 * k / fraction;
    return 1 / (fraction * std::sqrt(std::numbers::pi));
}

}  // namespace

double SphereRelease::relaxation_time() const {
    return diameter * diameter * (density_ratio + 0.5) / (18 * viscosity);
}

double SphereRelease::velocity(double time) const {
    const auto [a, b] = coefficients(*this);
    constexpr int points = 4000;  // of the midpoint rule in the angle whose tangent is y/sqrt(A)
    double sum = 0;
    for (int k = 0; k < points; ++k) {
        const double tangent = std::tan((k + 0.5) / points * std::numbers::pi / 2),
                     y = tangent * std::sqrt(a), apart = a - y * y;
        sum += (1 + tangent * tangent) * std::exp(-y * y * time) / (apart * apart + b * b * y * y);
    }
    return 1 - a * b * std::sqrt(a) / points * sum;
}

double SphereRelease::closed_velocity(double time) const {
    const auto [a, b] = coefficients(*this);
    const double half_gap = std::sqrt(b * b / 4 - a), large = b / 2 + half_gap, small = a / large;
    return 1 - (large * scaled_erfc(small * std::sqrt(time)) - small * scaled_erfc(large * std::sqrt(time))) /
                   (large - small);
}

}  // namespace talus::test
