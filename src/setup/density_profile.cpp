#include "src/setup/density_profile.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace talus {

using std::numbers::pi;

double enclosed_mass(DensityProfile profile, double radius) {
    if (profile == DensityProfile::inverse_radius) return radius * radius;
    if (profile == DensityProfile::even) return radius * radius * radius;
    const double x = pi * radius;
    return (std::sin(x) - x * std::cos(x)) / pi;
}

double radius_enclosing(DensityProfile profile, double mass) {
    if (profile == DensityProfile::inverse_radius) return std::sqrt(mass);
    const double even_radius = std::cbrt(mass);
    if (profile == DensityProfile::even) return even_radius;
    double low = 0, high = even_radius, radius = even_radius;  // the mass lies further in than an even one
    for (int iteration = 0; iteration < 60; ++iteration) {     // Newton's method, kept within bounds
        const double excess = enclosed_mass(profile, radius) - mass;
        (excess > 0 ? high : low) = radius;
        double next = radius - excess / (pi * radius * std::sin(pi * radius));
        if (!(low < next && next < high)) next = 0.5 * (low + high);
        if (std::abs(next - radius) <= 1e-15) break;
        radius = next;
    }
    return radius;
}

double density_at(DensityProfile profile, double radius) {
    if (profile == DensityProfile::even) return 1;
    if (profile == DensityProfile::inverse_radius) return 2.0 / 3 / radius;
    const double x = pi * radius;
    return pi * pi / 3 * (x > 0 ? std::max(std::sin(x), 0.0) / x : 1);
}

double polytropic_constant(double radius, double gravitational_constant) {
    return 2 * gravitational_constant * radius * radius / pi;
}

}  // namespace talus
