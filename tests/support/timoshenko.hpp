#pragma once
#include <cmath>
#include <numbers>

namespace talus::test {

/// A plate clamped at one end, in plane strain.
struct Cantilever {
    double length, thickness;                     ///< [m]
    double density, bulk_modulus, shear_modulus;  ///< [kg/m3], [Pa]

    double poisson() const {
        return (3 * bulk_modulus - 2 * shear_modulus) / (2 * (3 * bulk_modulus + shear_modulus));
    }
    /// E/(1 - nu^2) [Pa]
    double plate_modulus() const { return 2 * shear_modulus / (1 - poisson()); }
    /// Of angular frequency over sqrt(EI/(rho A L^4)).
    double period_of(double b) const {
        return 2 * std::numbers::pi * length * length / b /
               std::sqrt(plate_modulus() * thickness * thickness / (12 * density));
    }
};

/// First period of a thin plate [s]: L. D. Landau, E. M. Lifshitz, Theory of Elasticity, section 25,
/// problem 5.
inline double thin_period(const Cantilever& plate) {
    constexpr double k = 1.8751040687119611;
    return plate.period_of(k * k);
}

/// With shear and rotary inertia [s]: frequency equation of a clamped-free Timoshenko beam, T. C. Huang, J.
/// Appl. Mech. 28 (1961) 579; shear coefficient of G. R. Cowper, J. Appl. Mech. 33 (1966) 335, for plane
/// strain.
inline double timoshenko_period(const Cantilever& plate) {
    const double nu = plate.poisson() / (1 - plate.poisson());
    const double coefficient = 10 * (1 + nu) / (12 + 11 * nu);
    const double slenderness = plate.thickness / plate.length;
    const double r2 = slenderness * slenderness / 12;
    const double s2 = r2 * plate.plate_modulus() / (coefficient * plate.shear_modulus);
    const auto equation = [&](double b) {
        const double root = std::sqrt((r2 - s2) * (r2 - s2) + 4 / (b * b));
        const double alpha = b * std::sqrt(0.5 * (root - r2 - s2)),
                     beta = b * std::sqrt(0.5 * (root + r2 + s2));
        return 2 + (b * b * (r2 - s2) * (r2 - s2) + 2) * std::cosh(alpha) * std::cos(beta) -
               b * (r2 + s2) / std::sqrt(1 - b * b * r2 * s2) * std::sinh(alpha) * std::sin(beta);
    };
    double low = 1, high = 3.6;  // the first root lies below that of a thin beam, 3.516
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        (equation(low) * equation(middle) <= 0 ? high : low) = middle;
    }
    return plate.period_of(low);
}

}  // namespace talus::test
