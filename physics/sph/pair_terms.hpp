#pragma once
#include <algorithm>
#include <cmath>

#include "domain/lanes.hpp"
#include "physics/sph/settings.hpp"

namespace talus::sph {

/// Formulas of one pair, for Real = double or Lanes.

/// Specific volume along the line between two particles: at i (s = +distance/2) and at j (s = -distance/2)
/// its value, its slope and, for the quintic, its second derivative along the line.
template <class Real>
struct VolumeEnds {
    Real value_i, value_j;          ///< [m3/kg]
    Real slope_i, slope_j;          ///< [m2/kg]
    Real curve_i = 0, curve_j = 0;  ///< [m/kg]
};

/// Gaussian-weighted square of the specific volume and its first moment: V_ij^2 = <V^2>, and the interaction
/// acts at s*_ij = <s V^2>/<V^2>.
template <class Real>
struct VolumeMoments {
    Real square;  ///< <V^2> [m6/kg2]
    Real first;   ///< <s V^2> [m7/kg2]
};

/// Coefficients of V(s) = A s^3 + B s^2 + C s + D.
template <class Real>
struct CubicCoefficients {
    Real a, b, c, d;
};

/// The cubic through the ends where `cubic` is 1, the line where it is 0.
template <class Real>
CubicCoefficients<Real> interpolate_volume(const VolumeEnds<Real>& v, Real distance, Real inverse_distance,
                                           Real cubic) {
    const Real rise = (v.value_i - v.value_j) * inverse_distance, mean = 0.5 * (v.value_i + v.value_j);
    const Real slopes = v.slope_i + v.slope_j, bend = cubic * (v.slope_i - v.slope_j);
    const Real excess = cubic * (slopes - 2 * rise);
    return {excess * inverse_distance * inverse_distance, 0.5 * bend * inverse_distance, rise - 0.25 * excess,
            mean - 0.125 * bend * distance};
}

/// Moments under the weight sqrt(2/pi)/h exp(-2 s^2/h^2), with <s^2> = h^2/4, <s^4> = 3h^4/16,
/// <s^6> = 15h^6/64. S. Inutsuka, J. Comput. Phys. 179 (2002) 238, eqs 41-50.
template <class Real>
VolumeMoments<Real> cubic_moments(const CubicCoefficients<Real>& v, Real h2) {
    const Real m2 = 0.25 * h2, m4 = 0.75 * h2 * m2, m6 = 1.25 * h2 * m4;
    return {
        m6 * (v.a * v.a) + m4 * (2 * v.a * v.c + v.b * v.b) + m2 * (2 * v.b * v.d + v.c * v.c) + v.d * v.d,
        2 * (m6 * (v.a * v.b) + m4 * (v.a * v.d + v.b * v.c) + m2 * (v.c * v.d))};
}

/// As cubic_moments for V(s) = A s^5 + B s^4 + C s^3 + D s^2 + E s + F, with <s^8> = 105h^8/256 and
/// <s^10> = 945h^10/1024. K. Sugiura, S. Inutsuka, J. Comput. Phys. 308 (2016) 171, appendix.
template <class Real>
VolumeMoments<Real> quintic_moments(Real a, Real b, Real c, Real d, Real e, Real f, Real h2) {
    const Real m2 = 0.25 * h2, m4 = 0.75 * h2 * m2, m6 = 1.25 * h2 * m4, m8 = 1.75 * h2 * m6,
               m10 = 2.25 * h2 * m8;
    return {m10 * a * a + m8 * (2 * a * c + b * b) + m6 * (2 * a * e + 2 * b * d + c * c) +
                m4 * (2 * b * f + 2 * c * e + d * d) + m2 * (2 * d * f + e * e) + f * f,
            2 * (m10 * a * b + m8 * (a * d + b * c) + m6 * (a * f + b * e + c * d) + m4 * (c * f + d * e) +
                 m2 * e * f)};
}

/// Moments of the quintic through the ends.
template <class Real>
VolumeMoments<Real> quintic_moments(const VolumeEnds<Real>& v, Real distance, Real inverse_distance,
                                    Real h2) {
    const Real u = inverse_distance, rise = (v.value_i - v.value_j) * u;
    const Real slopes = v.slope_i + v.slope_j, bend = v.slope_i - v.slope_j;
    const Real curves = v.curve_i + v.curve_j, twist = v.curve_i - v.curve_j;
    const Real u2 = u * u;
    return quintic_moments<Real>(
        (6 * rise - 3 * slopes) * u2 * u2 + 0.5 * twist * u2 * u, -0.5 * bend * u2 * u + 0.25 * curves * u2,
        (-5 * rise + 2.5 * slopes) * u2 - 0.25 * twist * u, 0.75 * bend * u - 0.125 * curves,
        1.875 * rise - 0.4375 * slopes + 0.03125 * twist * distance,
        0.5 * (v.value_i + v.value_j) - 0.15625 * bend * distance + 0.015625 * curves * distance * distance,
        h2);
}

/// The slope of lesser size of two (minmod, where they agree in sign: P. L. Roe, Annu. Rev. Fluid Mech. 18
/// (1986) 337).
template <class Real>
Real lesser(Real own, Real secant) {
    using std::abs;
    return select(abs(own) < abs(secant), own, secant);
}

/// One side of a Riemann problem along the line between two particles.
template <class Real>
struct RiemannSide {
    Real density, pressure, velocity, sound_speed;
};
template <class Real>
struct RiemannSolution {
    Real pressure, velocity;
};

/// Pressure and velocity at the contact of a one-dimensional Riemann problem, `left` at negative coordinates.
/// Both waves are treated as shocks with W^2 = rho (rho c^2 + s (p* - p)): exact for shocks in an ideal gas
/// with s = (gamma + 1)/2 and in an isothermal solid P = c^2 (rho - rho0) with s = 1; rarefactions differ in
/// third order of their strength. Two-shock form of P. Colella, SIAM J. Sci. Stat. Comput. 3 (1982) 76.
/// Impedances W come first from the acoustic solution, to second order in the waves' strength W = rho (c +
/// s/2 |u* - u|) (J. K. Dukowicz, J. Comput. Phys. 61 (1985) 119), then from W^2 at that pressure (B. van
/// Leer, J. Comput. Phys. 32 (1979) 101). How close that comes: tests/unit/riemann.cpp. The mirrored problem
/// has the mirrored solution to the last bit.
template <class Real>
RiemannSolution<Real> solve_riemann(const RiemannSide<Real>& left, const RiemannSide<Real>& right,
                                    double shock_slope) {
    using std::max, std::sqrt;
    constexpr double least = 0.1, root_least = 0.31622776601683794;  // of (W / (rho c))^2, of W / (rho c)
    const Real approach = left.velocity - right.velocity, rise = right.pressure - left.pressure;
    const Real slope_left = shock_slope * left.density, slope_right = shock_slope * right.density;
    const Real z_left = left.density * left.sound_speed, z_right = right.density * right.sound_speed;

    Real inverse_sum = 1 / (z_left + z_right);
    const Real change_left = (z_right * approach + rise) * inverse_sum,  // of velocity across the wave
        change_right = (z_left * approach - rise) * inverse_sum;
    Real w_left = max(z_left + 0.5 * slope_left * change_left, root_least * z_left),
         w_right = max(z_right + 0.5 * slope_right * change_right, root_least * z_right), pressure;
    const auto meet = [&] {
        inverse_sum = 1 / (w_left + w_right);
        pressure =
            (w_right * left.pressure + w_left * right.pressure + w_left * w_right * approach) * inverse_sum;
    };
    meet();
    w_left = sqrt(max(z_left * z_left + slope_left * (pressure - left.pressure), least * (z_left * z_left)));
    w_right =
        sqrt(max(z_right * z_right + slope_right * (pressure - right.pressure), least * (z_right * z_right)));
    meet();
    return {pressure, (w_left * left.velocity + w_right * right.velocity - rise) * inverse_sum};
}

}  // namespace talus::sph
