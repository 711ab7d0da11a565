#pragma once
#include <cstdint>

namespace talus {

/// How the density of a ball depends on the distance from its centre. Lengths in units of its radius,
/// masses and densities in units of its mass and of its mean density.
enum class DensityProfile : std::uint8_t {
    even,
    inverse_radius,  ///< rho = 2/3 / r; A. E. Evrard, MNRAS 235 (1988) 911
    polytrope_1      ///< rho = pi^2/3 sin(pi r)/(pi r): P = K rho^2 in its own gravity
};

/// Mass within `radius` of the centre.
double enclosed_mass(DensityProfile profile, double radius);
/// Radius within which there is `mass`, 0 to 1.
double radius_enclosing(DensityProfile profile, double mass);
double density_at(DensityProfile profile, double radius);

/// K in P = K rho^2 of a ball in equilibrium with its own gravity, 2 G R^2/pi whatever its mass [m5 kg-1
/// s-2]. S. Chandrasekhar, An Introduction to the Study of Stellar Structure (1939), chapter IV, n = 1.
double polytropic_constant(double radius, double gravitational_constant);

}  // namespace talus
