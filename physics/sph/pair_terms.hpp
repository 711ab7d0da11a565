#pragma once
#include <algorithm>
#include <cmath>

#include "physics/sph/settings.hpp"

namespace talus::sph {

/// Specific volume along the line between two particles: at i (s = +distance/2) and at j (s = -distance/2)
/// its value, its slope and, for the quintic, its second derivative along the line.
struct VolumeEnds {
    double value_i, value_j;  ///< [m3/kg]
    double slope_i, slope_j;  ///< [m2/kg]
    double curve_i, curve_j;  ///< [m/kg]
};

/// Gaussian-weighted square of the specific volume and the place where the interaction acts.
struct VolumeMoments {
    double square;  ///< V_ij^2 [m6/kg2]
    double centre;  ///< s*_ij [m]
};

/// Moments of V(s) = A s^3 + B s^2 + C s + D under the weight sqrt(2/pi)/h exp(-2 s^2/h^2): V_ij^2 = <V^2>,
/// s* = <s V^2>/<V^2>, with <s^2> = h^2/4, <s^4> = 3h^4/16, <s^6> = 15h^6/64.
/// S. Inutsuka, J. Comput. Phys. 179 (2002) 238, eqs 41-50.
inline VolumeMoments cubic_moments(double a, double b, double c, double d, double h2) {
    const double m2 = 0.25 * h2, m4 = 0.1875 * h2 * h2, m6 = 0.234375 * h2 * h2 * h2;
    const double square = m6 * a * a + m4 * (2 * a * c + b * b) + m2 * (2 * b * d + c * c) + d * d;
    const double first = 2 * (m6 * a * b + m4 * (a * d + b * c) + m2 * c * d);
    return {square, first / square};
}

/// As cubic_moments for V(s) = A s^5 + B s^4 + C s^3 + D s^2 + E s + F, with <s^8> = 105h^8/256 and
/// <s^10> = 945h^10/1024. K. Sugiura, S. Inutsuka, J. Comput. Phys. 308 (2016) 171, appendix.
inline VolumeMoments quintic_moments(double a, double b, double c, double d, double e, double f, double h2) {
    const double m2 = 0.25 * h2, m4 = 0.75 * h2 * m2, m6 = 1.25 * h2 * m4, m8 = 1.75 * h2 * m6,
                 m10 = 2.25 * h2 * m8;
    const double square = m10 * a * a + m8 * (2 * a * c + b * b) + m6 * (2 * a * e + 2 * b * d + c * c) +
                          m4 * (2 * b * f + 2 * c * e + d * d) + m2 * (2 * d * f + e * e) + f * f;
    const double first = 2 * (m10 * a * b + m8 * (a * d + b * c) + m6 * (a * f + b * e + c * d) +
                              m4 * (c * f + d * e) + m2 * e * f);
    return {square, first / square};
}

/// Coefficients of the linear or cubic interpolation through the ends.
struct CubicCoefficients {
    double a, b, c, d;
};
inline CubicCoefficients interpolate_volume(const VolumeEnds& v, double inverse_distance, bool cubic) {
    const double rise = (v.value_i - v.value_j) * inverse_distance, mean = 0.5 * (v.value_i + v.value_j);
    const double distance_weight = cubic ? 1.0 : 0.0;
    const double distance = 1 / inverse_distance;
    const double slopes = v.slope_i + v.slope_j, bend = v.slope_i - v.slope_j;
    return {distance_weight * (slopes - 2 * rise) * inverse_distance * inverse_distance,
            distance_weight * 0.5 * bend * inverse_distance,
            rise + distance_weight * (0.5 * rise - 0.25 * slopes),
            mean - distance_weight * 0.125 * bend * distance};
}

inline VolumeMoments quintic_volume(const VolumeEnds& v, double distance, double inverse_distance,
                                    double h2) {
    const double u = inverse_distance, rise = (v.value_i - v.value_j) * u;
    const double slopes = v.slope_i + v.slope_j, bend = v.slope_i - v.slope_j;
    const double curves = v.curve_i + v.curve_j, twist = v.curve_i - v.curve_j;
    const double u2 = u * u;
    return quintic_moments(
        (6 * rise - 3 * slopes) * u2 * u2 + 0.5 * twist * u2 * u, -0.5 * bend * u2 * u + 0.25 * curves * u2,
        (-5 * rise + 2.5 * slopes) * u2 - 0.25 * twist * u, 0.75 * bend * u - 0.125 * curves,
        1.875 * rise - 0.4375 * slopes + 0.03125 * twist * distance,
        0.5 * (v.value_i + v.value_j) - 0.15625 * bend * distance + 0.015625 * curves * distance * distance,
        h2);
}

/// Slope between two particles: the lesser of a particle's own and the one between their values, 0 where they
/// disagree in sign (minmod: P. L. Roe, Annu. Rev. Fluid Mech. 18 (1986) 337).
inline double limited_slope(double own, double secant) {
    const double lesser = std::abs(own) < std::abs(secant) ? own : secant;
    return own * secant > 0 ? lesser : 0.0;
}

/// One side of a Riemann problem along the line between two particles.
struct RiemannSide {
    double density, pressure, velocity, sound_speed;
};
struct RiemannSolution {
    double pressure, velocity;
};

/// Pressure and velocity at the contact of a one-dimensional Riemann problem, `left` at negative coordinates.
/// Both waves are treated as shocks with W^2 = rho (rho c^2 + s (p* - p)): exact for shocks in an ideal gas
/// with s = (gamma + 1)/2 and in an isothermal solid P = c^2 (rho - rho0) with s = 1; rarefactions differ in
/// third order of their strength. Iteration of B. van Leer, J. Comput. Phys. 32 (1979) 101; two-shock form of
/// P. Colella, SIAM J. Sci. Stat. Comput. 3 (1982) 76. A fixed number of iterations, so that loops vectorise.
inline RiemannSolution solve_riemann(const RiemannSide& left, const RiemannSide& right, double shock_slope) {
    const double impedance2_left = left.density * left.density * left.sound_speed * left.sound_speed;
    const double impedance2_right = right.density * right.density * right.sound_speed * right.sound_speed;
    double w_left = left.density * left.sound_speed, w_right = right.density * right.sound_speed;
    const double approach = left.velocity - right.velocity;
    double pressure = (w_right * left.pressure + w_left * right.pressure + w_left * w_right * approach) /
                      (w_left + w_right);
    for (int iteration = 0; iteration < 2; ++iteration) {
        w_left = std::sqrt(std::max(impedance2_left + shock_slope * left.density * (pressure - left.pressure),
                                    0.1 * impedance2_left));
        w_right =
            std::sqrt(std::max(impedance2_right + shock_slope * right.density * (pressure - right.pressure),
                               0.1 * impedance2_right));
        pressure = (w_right * left.pressure + w_left * right.pressure + w_left * w_right * approach) /
                   (w_left + w_right);
    }
    const double velocity =
        (w_left * left.velocity + w_right * right.velocity + left.pressure - right.pressure) /
        (w_left + w_right);
    return {pressure, velocity};
}

}  // namespace talus::sph
