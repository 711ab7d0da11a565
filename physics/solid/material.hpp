#pragma once
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "physics/solid/equation_of_state.hpp"
#include "physics/solid/fracture.hpp"
#include "physics/solid/plasticity.hpp"
#include "physics/solid/strength.hpp"

namespace talus {

/// Everything a body is made of. A fluid has no shear modulus; what does not crack has no fracture.
struct Material {
    std::string name;                        ///< of its file in runs/materials
    EquationOfState eos;                     ///< pressure and sound speed
    double shear_modulus = 0;                ///< mu [Pa]
    double bulk_modulus = 0;                 ///< K [Pa] of small strains: A of Tillotson, rho0 c^2 otherwise
    double reference_density = 0;            ///< density of a body at rest [kg/m3]
    Strength strength{};                     ///< limit of the deviatoric stress
    std::optional<Fracture> fracture{};      ///< flaws and cracks, if it is brittle
    std::optional<Plasticity> plasticity{};  ///< of soil, in place of `strength`; the pressure is linear then
    /// Less pressure than this opens the matter, which keeps it [Pa]: 0 for fluids that bear no tension.
    double least_pressure = -std::numeric_limits<double>::infinity();
    double initial_internal_energy = 0;  ///< of a body at rest [J/kg]
    double stiffness = 1;                ///< moduli in those of the real rock (late_phase.hpp) [1]

    Elasticity elasticity() const { return {bulk_modulus, shear_modulus, reference_density}; }
    /// E = 9 K mu / (3 K + mu) [Pa].
    double young_modulus() const {
        return 9 * bulk_modulus * shear_modulus / (3 * bulk_modulus + shear_modulus);
    }
    /// c_L = sqrt((K + 4 mu/3) / rho0) [m/s], of longitudinal elastic waves.
    double longitudinal_speed() const {
        return std::sqrt((bulk_modulus + 4 * shear_modulus / 3) / reference_density);
    }
    /// Crack growth at the real rock's constants; only if it has a fracture model.
    CrackGrowth crack_growth() const {
        return {.crack_speed = fracture->crack_speed_fraction * longitudinal_speed() / std::sqrt(stiffness),
                .young_modulus = young_modulus() / stiffness,
                .crack_count_power = fracture->crack_count_power};
    }
};

/// Bulk modulus [Pa] of an equation of state at its reference density and u = 0.
inline double bulk_modulus(const EquationOfState& eos) {
    if (const auto* tillotson = std::get_if<Tillotson>(&eos)) return tillotson->bulk_modulus();
    const double density = reference_density(eos), c = evaluate(eos, density, 0).sound_speed;
    return density * c * c;
}

}  // namespace talus
