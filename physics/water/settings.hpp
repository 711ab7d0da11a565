#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "physics/water/rheology.hpp"

namespace talus::water {

/// Pressure of a barely compressible fluid, p = p0 + rho0 c0^2/gamma ((rho/rho0)^gamma - 1). J. J. Monaghan,
/// J. Comput. Phys. 110 (1994) 399, eq. 4.
struct Tait {
    double reference_density = 1000;  ///< rho0 [kg/m3]
    double sound_speed = 0;           ///< c0 [m/s]
    int exponent = 7;                 ///< gamma, at least 2 [1]
    double background_pressure = 0;   ///< p0 [Pa]

    double stiffness() const { return reference_density * sound_speed * sound_speed / exponent; }
    double pressure(double density) const {
        return background_pressure + stiffness() * (power(density / reference_density, exponent) - 1);
    }
    double density(double pressure) const {
        return reference_density *
               std::pow(1 + (pressure - background_pressure) / stiffness(), 1.0 / exponent);
    }
    double sound_speed_at(double density) const {
        return sound_speed * std::sqrt(power(density / reference_density, exponent - 1));
    }
    /// Energy of compression per mass, the integral of p/rho^2 from rho0 on [J/kg].
    double energy(double density) const {
        const double s = density / reference_density;
        return stiffness() / reference_density * ((power(s, exponent - 1) - 1) / (exponent - 1) + 1 / s - 1) +
               background_pressure / reference_density * (1 - 1 / s);
    }

    /// Integral of dp/rho from rho0 on, over c0^2, nearly rho/rho0 - 1. At rest it falls by g/c0^2 each metre
    /// that water is higher, exactly [1].
    double enthalpy(double density) const {
        return (power(density / reference_density, exponent - 1) - 1) / (exponent - 1);
    }

  private:
    static double power(double base, int exponent) {
        double product = base;
        for (int k = 1; k < exponent; ++k) product *= base;
        return product;
    }
};

/// Share of the volume that grains leave to the water: at least a fifth, however many there are.
inline double share_of_water(double solid_fraction) { return 1 - std::min(solid_fraction, 0.8); }

/// Pressure in the middle of a wall's core, over rho0 c0^2 [1].
inline constexpr double core_hardness = 4;

/// What a scene says of its water, resolved.
struct Settings {
    Tait state;
    double smoothing_length = 0;         ///< h; the kernel, Wendland's C2, ends at 2 h [m]
    double viscosity = 0;                ///< the same everywhere [Pa s]
    std::optional<Rheology> rheology{};  ///< instead
    double artificial_viscosity = 0;     ///< alpha [1]
    double density_diffusion = 0.1;      ///< delta [1]
    double shifting = 0;                 ///< of particles towards even places, see force_pass() [1]
    std::array<double, 3> gravity{};     ///< [m/s2]
    /// Gravity along axes that have an end, whose weight pressure bears at rest [m/s2].
    std::array<double, 3> bearing{};
    double courant = 0.4;

    double radius_in_spacings = 0;  ///< radius of interaction over the spacing of the particles [1]
    double wall_core = 0;           ///< water nearer to a particle of a wall is pushed off, 0: nowhere [m]

    static constexpr double support() { return 2; }  ///< of the kernel [h]
    /// That any of the water may have [Pa s].
    double greatest_viscosity() const { return rheology ? rheology->greatest_viscosity : viscosity; }
    /// Longest step by viscosity, 7/8 of what is stable where velocities alternate between particles:
    /// friction damps those at a rate of 7 mu/(rho h^2) [s].
    double viscous_time_step() const {
        const double greatest = greatest_viscosity();
        return greatest > 0 ? 0.125 * smoothing_length * smoothing_length * state.reference_density / greatest
                            : std::numeric_limits<double>::infinity();
    }
    double radius() const { return support() * smoothing_length; }
    double spacing() const { return radius() / radius_in_spacings; }  ///< of the particles [m]
};

}  // namespace talus::water
