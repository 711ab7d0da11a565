#include "tests/support/sedov_taylor.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace talus::reference {

namespace {

struct Ends {
    double centre, shock;  ///< values of the parameter V
};
Ends ends(double gamma) { return {2 / (5 * gamma), 4 / (5 * (gamma + 1))}; }

}  // namespace

SedovTaylor::SedovTaylor(double energy, double density, double gamma)
    : energy_(energy), density_(density), gamma_(gamma) {
    if (!(energy > 0 && density > 0 && gamma > 1.2 && gamma < 2))
        throw std::invalid_argument("SedovTaylor: not a gas, or gamma out of range");
    // Energy of the profile for a shock of radius 1 at time 1, over V = centre + (shock - centre) s^4: dense
    // where the radius falls to 0 steeply.
    const double u2 = 2 / (gamma + 1) * 0.4, rho2 = (gamma + 1) / (gamma - 1),
                 p2 = 2 / (gamma + 1) * 0.4 * 0.4;
    const auto [centre, shock] = ends(gamma);
    constexpr int steps = 20000;
    Profile before{0, 0, 0, 0};
    double e_before = 0;
    for (int k = 1; k <= steps; ++k) {
        const double s = static_cast<double>(k) / steps;
        const Profile now = profile(centre + (shock - centre) * s * s * s * s);
        const double u = u2 * now.velocity;
        const double e = 0.5 * rho2 * now.density * u * u + p2 * now.pressure / (gamma - 1);
        const double volume =
            4.0 / 3 * std::numbers::pi *
            (now.radius * now.radius * now.radius - before.radius * before.radius * before.radius);
        alpha_ += 0.5 * (k > 1 ? e + e_before : 2 * e) * volume;
        before = now;
        e_before = e;
    }
}

SedovTaylor::Profile SedovTaylor::profile(double v) const {
    const double g = gamma_, j = 3, k = 5;  // k = j + 2 - omega
    const double a = k * (g + 1) / 4, b = (g + 1) / (g - 1), c = k * g / 2,
                 d = k * (g + 1) / (k * (g + 1) - 2 * (2 + j * (g - 1))), e = (2 + j * (g - 1)) / 2;
    const double alpha0 = 2 / k, alpha2 = -(g - 1) / (2 * (g - 1) + j),
                 alpha1 = k * g / (2 + j * (g - 1)) * (2 * j * (2 - g) / (g * k * k) - alpha2),
                 alpha3 = j / (2 * (g - 1) + j), alpha4 = alpha1 * k / (2 - g), alpha5 = -2 / (2 - g);
    const double x1 = a * v, x2 = b * std::max(c * v - 1, 0.0), x3 = d * (1 - e * v),
                 x4 = b * (1 - c * v / g);
    const double radius = std::pow(x1, -alpha0) * std::pow(x2, -alpha2) * std::pow(x3, -alpha1);
    return {radius, x1 * radius, std::pow(x2, alpha3) * std::pow(x3, alpha4) * std::pow(x4, alpha5),
            std::pow(x1, alpha0 * j) * std::pow(x3, alpha4 - 2 * alpha1) * std::pow(x4, 1 + alpha5)};
}

double SedovTaylor::shock_radius(double time) const {
    return std::pow(energy_ * time * time / (alpha_ * density_), 0.2);
}

GasState SedovTaylor::operator()(double radius, double time) const {
    const double at_shock = shock_radius(time), wanted = radius / at_shock;
    if (wanted >= 1) return {density_, 0, 0};
    auto [low, high] = ends(gamma_);
    while (high - low > 1e-15 * high) {
        const double middle = 0.5 * (low + high);
        if (middle == low || middle == high) break;
        (profile(middle).radius < wanted ? low : high) = middle;
    }
    const Profile found = profile(high);
    const double speed = 0.4 * at_shock / time;
    return {(gamma_ + 1) / (gamma_ - 1) * density_ * found.density, 2 / (gamma_ + 1) * speed * found.velocity,
            2 / (gamma_ + 1) * density_ * speed * speed * found.pressure};
}

}  // namespace talus::reference
