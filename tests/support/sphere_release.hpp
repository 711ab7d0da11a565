#pragma once

namespace talus::test {

/// A sphere let go in a viscous fluid at rest: velocity over the terminal one under weight, buoyancy, Stokes
/// drag, virtual mass and Basset's history force. The Laplace transform of (sigma + 1/2) rho V dv/dt = (sigma
/// - 1) rho V g - 3 pi mu d v - 3/2 d^2 (pi rho mu)^(1/2) integral of v'(t') (t - t')^(-1/2) dt' is
/// A/(s (s + B sqrt(s) + A)) with A = 36 nu/(d^2 (2 sigma + 1)), B = 18 sqrt(nu)/(d (2 sigma + 1)): R.
/// Clift, J. R. Grace, M. E. Weber, Bubbles, Drops, and Particles (1978), ch. 11.
struct SphereRelease {
    double diameter;       ///< [m]
    double viscosity;      ///< nu [m2/s]
    double density_ratio;  ///< sigma, of sphere over fluid [1]

    /// d^2 (sigma + 1/2)/(18 nu) [s].
    double relaxation_time() const;
    /// By inversion around the cut of the root, 1 - 2 A B/pi integral of exp(-y^2 t)/((A - y^2)^2 + B^2 y^2)
    /// dy from 0 on.
    double velocity(double time) const;
    /// By error functions, for density ratios below 5/8, where roots of y^2 + B y + A are real.
    double closed_velocity(double time) const;
};

}  // namespace talus::test
