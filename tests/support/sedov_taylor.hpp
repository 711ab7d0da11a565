#pragma once
#include "tests/support/exact_riemann.hpp"

namespace talus::reference {

/// Point explosion in three dimensions in a cold ideal gas of uniform density. L. I. Sedov, Similarity and
/// Dimensional Methods in Mechanics, Academic Press 1959, ch. IV; in the form of J. R. Kamm, F. X. Timmes,
/// Los Alamos report LA-UR-07-2849 (2007), eqs 38-53 with j = 3 and omega = 0.
class SedovTaylor {
  public:
    /// `energy` [J], `density` of the undisturbed gas [kg/m3], 1.2 < gamma < 2. Throws std::invalid_argument
    /// outside.
    SedovTaylor(double energy, double density, double gamma);

    /// The shock is at (energy time^2 / (alpha density))^(1/5).
    double alpha() const { return alpha_; }
    double shock_radius(double time) const;
    /// Radial velocity, density and pressure.
    GasState operator()(double radius, double time) const;

  private:
    struct Profile {  // relative to the shock's radius and to the values behind it
        double radius, velocity, density, pressure;
    };
    Profile profile(double v) const;

    double energy_, density_, gamma_, alpha_ = 0;
};

}  // namespace talus::reference
