#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>

namespace talus {

/// Pressure [Pa] and the square of the sound speed [m2/s2] of one state. The square may be negative in
/// unphysical parts of a plane; `sound_speed` below applies the floor.
struct EosState {
    double pressure, sound_speed_squared;
};

/// P = (gamma - 1) rho u.
struct IdealGas {
    double gamma = 1.4;              ///< ratio of specific heats [1]
    double reference_density = 1.0;  ///< density at the start [kg/m3]; does not enter the pressure

    EosState state(double density, double internal_energy) const {
        const double pressure = (gamma - 1) * density * internal_energy;
        return {pressure, gamma * (gamma - 1) * internal_energy};
    }
    double least_sound_speed_squared() const { return 0; }
    double pressure(double density, double internal_energy) const {
        return state(density, internal_energy).pressure;
    }
};

/// P = c^2 (rho - rho0): isothermal, the energy has no say.
struct LinearEquationOfState {
    double reference_density;  ///< rho0 [kg/m3]
    double sound_speed;        ///< c [m/s]

    EosState state(double density, double) const {
        return {sound_speed * sound_speed * (density - reference_density), sound_speed * sound_speed};
    }
    double least_sound_speed_squared() const { return sound_speed * sound_speed; }
    double pressure(double density, double internal_energy) const {
        return state(density, internal_energy).pressure;
    }
};

/// Stiffened gas P = (gamma - 1) rho u + c0^2 (rho - rho0), the energy counted from the state of zero
/// pressure at rho0. With u = e - q and P_inf = rho0 c0^2 / gamma this is the usual
/// P = (gamma - 1) rho e - gamma P_inf, so c^2 = gamma (P + P_inf) / rho.
/// F. H. Harlow, A. A. Amsden, Fluid Dynamics, LA-4700 (1971); R. Menikoff, B. J. Plohr, Rev. Mod. Phys. 61
/// (1989) 75.
struct StiffenedGas {
    double gamma;              ///< Grueneisen coefficient + 1 [1]
    double reference_density;  ///< rho0 [kg/m3]
    double sound_speed;        ///< c0, at (rho0, u = 0) [m/s]

    EosState state(double density, double internal_energy) const {
        const double stiffness = reference_density * sound_speed * sound_speed;
        const double pressure = (gamma - 1) * density * internal_energy +
                                sound_speed * sound_speed * (density - reference_density);
        return {pressure, (gamma * pressure + stiffness) / density};
    }
    double least_sound_speed_squared() const { return 1e-4 * sound_speed * sound_speed; }
    double pressure(double density, double internal_energy) const {
        return state(density, internal_energy).pressure;
    }
};

/// Tillotson's equation of state for impacts: a cold and compressed form, a hot expanded form, and between
/// E_iv and E_cv below the reference density a blend of both, linear in the energy.
/// J. H. Tillotson, General Atomic report GA-3216 (1962); H. J. Melosh, Impact Cratering (1989), appendix II;
/// W. Benz, E. Asphaug, Icarus 142 (1999) 5.
///
/// The pressure is continuous everywhere. The sound speed is that of this pressure, exactly, and therefore
/// continuous at rho0, while across E_iv and E_cv its square jumps by P (P_hot - P_cold) / (rho^2 (E_cv -
/// E_iv)), the kink of the blend.
struct Tillotson {
    double reference_density;         ///< rho0 [kg/m3]
    double a, b;                      ///< Grueneisen coefficients, a + b cold and a hot [1]
    double A, B;                      ///< bulk modulus and its second-order companion [Pa]
    double E0;                        ///< energy at which b has halved, at rho0 [J/kg]
    double E_iv, E_cv;                ///< energies of incipient and complete vaporisation [J/kg]
    double alpha, beta;               ///< decay of the solid's terms on expansion [1]
    double cold_cut_ratio = 0;        ///< below this rho/rho0 cold matter has no pressure [1]; 0: no cut
    double least_speed_ratio = 0.01;  ///< floor of the sound speed in units of sqrt(A/rho0) [1]

    double bulk_modulus() const { return A; }
    double least_sound_speed_squared() const {
        return least_speed_ratio * least_speed_ratio * A / reference_density;
    }

    /// Compressed or cold: P = (a + b/w) rho u + A mu + B mu^2, w = u/(E0 eta^2) + 1.
    EosState cold(double density, double internal_energy) const {
        const double u = internal_energy, eta = density / reference_density, mu = eta - 1;
        const double w = u / (E0 * eta * eta) + 1;
        const double gruneisen = a + b / w;
        const double P = gruneisen * density * u + A * mu + B * mu * mu;
        const double dP_drho =
            gruneisen * u + 2 * b * u * (w - 1) / (w * w) + (A + 2 * B * mu) / reference_density;
        const double dP_du = density * (a + b / (w * w));
        return {P, dP_drho + P / (density * density) * dP_du};
    }

    /// Hot expanded: P = a rho u + [b rho u/w + A mu exp(-beta z)] exp(-alpha z^2), z = rho0/rho - 1.
    EosState hot(double density, double internal_energy) const {
        const Slopes s = hot_slopes(density, internal_energy);
        return {s.P, s.dP_drho + s.P / (density * density) * s.dP_du};
    }

    EosState state(double density, double internal_energy) const {
        if (density >= reference_density) return cold(density, internal_energy);
        if (internal_energy <= E_iv) {
            if (density < cold_cut_ratio * reference_density) return {0, 0};
            return cold(density, internal_energy);
        }
        if (internal_energy >= E_cv) return hot(density, internal_energy);
        return blend(density, internal_energy);
    }
    double pressure(double density, double internal_energy) const {
        return state(density, internal_energy).pressure;
    }

  private:
    struct Slopes {
        double P, dP_drho, dP_du;
    };
    Slopes hot_slopes(double density, double internal_energy) const;
    EosState blend(double density, double internal_energy) const;
};

using EquationOfState = std::variant<Tillotson, IdealGas, LinearEquationOfState, StiffenedGas>;

/// Sound speed [m/s] of a state; never below the equation's own floor, so that a negative square in an
/// unphysical corner of the plane does no harm.
template <class Eos>
double sound_speed(const Eos& eos, const EosState& state) {
    return std::sqrt(std::max(state.sound_speed_squared, eos.least_sound_speed_squared()));
}

/// Pressure [Pa] and sound speed [m/s] of one state.
struct PressureAndSound {
    double pressure, sound_speed;
};
PressureAndSound evaluate(const EquationOfState& eos, double density, double internal_energy);

/// Pressure [Pa] of one state.
double pressure(const EquationOfState& eos, double density, double internal_energy);

/// Density [kg/m3] the equation is written around.
double reference_density(const EquationOfState& eos);

/// Pressure and sound speed of every entry; all spans of one length.
void evaluate(const EquationOfState& eos, std::span<const double> density,
              std::span<const double> internal_energy, std::span<double> pressure,
              std::span<double> sound_speed);

/// The same for the entries with body == which; the others are left alone.
void evaluate(const EquationOfState& eos, std::span<const double> density,
              std::span<const double> internal_energy, std::span<double> pressure,
              std::span<double> sound_speed, std::span<const std::uint8_t> body, std::uint8_t which);

/// Ends of an interval.
struct Interval {
    double low, high;
};

/// Where in the (density, energy) plane an equation of state is unphysical.
struct ScanResult {
    std::size_t points = 0;     ///< states looked at
    std::size_t imaginary = 0;  ///< of them with c^2 < 0
    std::size_t floored = 0;    ///< of them with c^2 below the floor, the imaginary ones included
    double worst_c2 = 0;        ///< least c^2 met [m2/s2]
    double at_density = 0;      ///< where that was [kg/m3]
    double at_energy = 0;       ///< [J/kg]
    /// Densest state with c^2 < 0 [kg/m3]; 0 if there is none. A dense one deserves a warning.
    double densest_imaginary = 0;
};

/// Looks for c^2 < 0 on a grid over rho/rho0 in `density_ratio` (equal steps) and u in `energy` [J/kg] (0 or
/// the lower end, then equal steps of the logarithm from a thousandth of E_iv). Takes a few milliseconds.
ScanResult scan(const Tillotson& eos, Interval density_ratio = {0.02, 4.0}, Interval energy = {0, 1e9});

}  // namespace talus
