#pragma once
#include <cmath>
#include <stdexcept>

#include "physics/solid/equation_of_state.hpp"

namespace talus::test {

/// State behind a plane shock running into matter at rest.
struct ShockState {
    double pressure, shock_speed, particle_speed, density, internal_energy;  ///< SI, speeds in the lab frame
};

/// Solves the Rankine-Hugoniot relations for a piston of speed u_p [m/s] driven into (rho0, u0):
/// rho0 U = rho (U - u_p), P - P0 = rho0 U u_p, u - u0 = (P + P0)/2 (1/rho0 - 1/rho), P = P(rho, u).
inline ShockState shock_behind_piston(const EquationOfState& eos, double density0, double energy0,
                                      double particle_speed) {
    const double pressure0 = pressure(eos, density0, energy0);
    const auto at = [&](double compression) {
        const double U = particle_speed * compression / (compression - 1);
        const double P = pressure0 + density0 * U * particle_speed;
        const double u = energy0 + 0.5 * (P + pressure0) / density0 * (1 - 1 / compression);
        return ShockState{P, U, particle_speed, density0 * compression, u};
    };
    const auto excess = [&](double compression) {
        const ShockState s = at(compression);
        return s.pressure - pressure(eos, s.density, s.internal_energy);
    };
    // The momentum needs an infinite pressure at no compression, so the excess starts positive.
    double low = 1 + 1e-9, high = low;
    while (excess(high) > 0) {
        low = high;
        high = 1 + (high - 1) * 1.05;
        if (high > 100) throw std::runtime_error("no shock state found");
    }
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        (excess(middle) > 0 ? low : high) = middle;
    }
    return at(0.5 * (low + high));
}

/// Two equal bodies at (rho0, u0) meeting at `speed` [m/s]: each sees a piston of half of it. Shock speed is
/// relative to the unshocked matter.
inline ShockState symmetric_impact(const EquationOfState& eos, double density0, double energy0,
                                   double speed) {
    return shock_behind_piston(eos, density0, energy0, speed / 2);
}

}  // namespace talus::test
