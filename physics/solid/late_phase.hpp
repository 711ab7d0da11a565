#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "physics/solid/material.hpp"

namespace talus {

/// From `from` on rock is softer than it is, so that sound, and with it the time step, does not keep pace
/// with waves that no longer matter: what is left, sliding and falling together under gravity, is slower by
/// orders of magnitude. S. D. Raducan, M. Jutzi, Planet. Sci. J. 3 (2022) 128, section 2.4, lower the bulk
/// modulus for the same reason. Here pressure, stress and strength are carried over, only densities change.
struct LatePhase {
    double from;       ///< time [s]
    double stiffness;  ///< pressure and shear modulus, in those of the material [1]
};

inline constexpr double most_compressed = 4;  ///< density over that at rest that keep_pressure() allows

/// The material with its pressure at every density and energy, and its shear modulus, times `stiffness`: warm
/// rock is free of pressure at the density where it was. Strength and the growth of cracks at a given stress
/// stay as they are. Throws std::invalid_argument for an ideal gas, whose stiffness is its pressure.
Material softened(const Material& material, double stiffness);

/// Moves the density of every particle with body == which to where the softened equation of state gives the
/// pressure that `before` has now, at the same internal energy. Matter that is stretched further than the
/// softer one could hold (torn or loose) keeps its density; matter that would have to be denser than
/// most_compressed times the density at rest loses pressure. Returns the places of such particles.
std::vector<std::size_t> keep_pressure(const EquationOfState& before, const EquationOfState& after,
                                       std::span<const double> internal_energy, std::span<double> density,
                                       std::span<const std::uint8_t> body, std::uint8_t which);

}  // namespace talus
