#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/dem/vector3.hpp"

namespace talus::coupling {

/// A sphere in a flow: `slip` = u - v [m/s], `vorticity` of the fluid [1/s].
struct ShearedSphere {
    double density, viscosity;  ///< of the fluid [kg/m3], [Pa s]
    double diameter;            ///< [m]
    dem::Vector3<> slip, vorticity;
};

/// Lift of a sphere that lags behind a sheared fluid, 1.615 d^2 (rho mu/|w|)^(1/2) (u - v) x w: P. G.
/// Saffman, J. Fluid Mech. 22 (1965) 385 and 31 (1968) 624; for finite Reynolds numbers with the factor of R.
/// Mei, Int. J. Multiphase Flow 18 (1992) 145.
inline dem::Vector3<> saffman_mei_lift(const ShearedSphere& s) {
    const double w = norm(s.vorticity), speed = norm(s.slip);
    if (w == 0 || speed == 0) return {};
    const double reynolds = s.density * speed * s.diameter / s.viscosity;
    const double beta = 0.5 * s.diameter * w / speed;
    const double factor =
        reynolds <= 40 ? (1 - 0.3314 * std::sqrt(beta)) * std::exp(-0.1 * reynolds) + 0.3314 * std::sqrt(beta)
                       : 0.0524 * std::sqrt(beta * reynolds);
    return factor * 1.615 * s.diameter * s.diameter * std::sqrt(s.density * s.viscosity / w) *
           cross(s.slip, s.vorticity);
}

/// Lift of a sphere that spins otherwise than the fluid, pi/8 rho d^3 (w/2 - omega) x (u - v) with the spin
/// omega: S. I. Rubinow, J. B. Keller, J. Fluid Mech. 11 (1961) 447.
inline dem::Vector3<> magnus_lift(const ShearedSphere& s, const dem::Vector3<>& spin) {
    return std::numbers::pi / 8 * s.density * s.diameter * s.diameter * s.diameter *
           cross(0.5 * s.vorticity - spin, s.slip);
}

}  // namespace talus::coupling
