#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <variant>

#include "physics/solid/stress_state.hpp"

namespace talus {

/// Fraction of the strength left at specific energy u: 1 - u/u_melt, within [0, 1].
inline double thermal_softening(double internal_energy, double melt_energy) {
    return std::clamp(1 - internal_energy / melt_energy, 0.0, 1.0);
}

// Damage takes shear from rock in one of two ways, `damage_scales_stress`. True: cracks carry nothing, the
// stress is (1 - D) S in all, with S that of the uncracked part; W. Benz, E. Asphaug, Icarus 107 (1994) 98.
// False: only the strength falls, towards friction on the cracks; M. Jutzi, Planet. Space Sci. 107 (2015) 3;
// K. Sugiura, H. Kobayashi, S. Inutsuka, Astron. Astrophys. 620 (2018) A167.

/// Yield stress independent of the pressure, reduced by heat and damage: sqrt(3 J2) <= Y_M (1 - u/u_melt)
/// (1 - D). W. Benz, E. Asphaug, Comput. Phys. Commun. 87 (1995) 253, with the radial return of
/// L. D. Libersky, A. G. Petschek (1991): S is scaled by Y/sqrt(3 J2), not by its square.
struct VonMises {
    static constexpr bool damage_scales_stress = true;
    double yield_stress;                                           ///< Y_M in simple tension [Pa]
    double melt_energy = std::numeric_limits<double>::infinity();  ///< u_melt [J/kg]

    double shear_strength(double, double internal_energy, double damage) const {
        constexpr double tension_to_shear = 0.57735026918962576451;  // 1/sqrt(3)
        return tension_to_shear * yield_stress * thermal_softening(internal_energy, melt_energy) *
               (1 - damage);
    }
};

/// Pressure-dependent strength of rock. Intact: Y_i = [Y_0 + mu_i P / (1 + mu_i P/(Y_M - Y_0))] (1 -
/// u/u_melt); fully damaged: Coulomb friction Y_d = min(mu_d P, Y_i); between: Y = (1 - D) Y_i + D Y_d; P =
/// max(P, 0). Compared with sqrt(J2). N. Lundborg, Int. J. Rock Mech. Min. Sci. 5 (1968) 427; G. S. Collins,
/// H. J. Melosh, B. A. Ivanov, Meteorit. Planet. Sci. 39 (2004) 217; M. Jutzi, Planet. Space Sci.
/// 107 (2015) 3 (eq. 6 as printed has D - 1 for 1 - D).
struct Lundborg {
    static constexpr bool damage_scales_stress = false;
    double cohesion;          ///< Y_0, strength at P = 0 [Pa]
    double limit;             ///< Y_M, strength at P -> infinity [Pa], at least Y_0
    double friction_intact;   ///< mu_i [1]
    double friction_damaged;  ///< mu_d [1]
    double melt_energy = std::numeric_limits<double>::infinity();  ///< u_melt [J/kg]

    double shear_strength(double pressure, double internal_energy, double damage) const {
        const double P = std::max(pressure, 0.0), range = limit - cohesion;
        const double frictional = range > 0 ? friction_intact * P * range / (range + friction_intact * P) : 0;
        const double intact = (cohesion + frictional) * thermal_softening(internal_energy, melt_energy);
        const double damaged = std::min(friction_damaged * P, intact);
        return (1 - damage) * intact + damage * damaged;
    }
};

/// Purely elastic: the deviatoric stress of the uncracked part is never limited.
struct NoStrengthLimit {
    static constexpr bool damage_scales_stress = true;
    double shear_strength(double, double, double) const { return std::numeric_limits<double>::infinity(); }
};

using Strength = std::variant<NoStrengthLimit, VonMises, Lundborg>;

/// Largest sqrt(J2) [Pa] that the material bears at pressure P [Pa], energy u [J/kg] and damage D.
double shear_strength(const Strength& strength, double pressure, double internal_energy, double damage);

/// What the deviatoric stress is multiplied with: min(strength / sqrt(J2), 1).
double limit_factor(const Strength& strength, double sqrt_J2, double pressure, double internal_energy,
                    double damage);

/// What the limit is computed from, one value a particle. Without `damage` (empty) the material is intact.
struct StrengthState {
    std::span<const double> pressure;         ///< [Pa]
    std::span<const double> internal_energy;  ///< [J/kg]
    std::span<const double> damage;           ///< [1], or empty
};

/// Brings the deviatoric stress of all particles with body == which within the strength, in place. Where
/// damage scales the stress, it is that of the uncracked part, within the strength of intact matter.
void limit_stress(const Strength& strength, const StrengthState& state, StressColumns<double> stress,
                  std::span<const std::uint8_t> body, std::uint8_t which);

/// What cracked matter carries of the stress of its uncracked part, for all particles with body == which, in
/// place: (1 - D) P if P < 0, and (1 - D) S if damage scales the stress. After limits and crack growth, which
/// need the stress of the uncracked part.
void relieve_stress(const Strength& strength, std::span<const double> damage, std::span<double> pressure,
                    StressColumns<double> stress, std::span<const std::uint8_t> body, std::uint8_t which);

}  // namespace talus
