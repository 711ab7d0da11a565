#pragma once
#include <cstdint>
#include <optional>

#include "physics/depth/two_phase.hpp"

namespace talus::depth {

/// How the equations meet a bed that is not level.
enum class Form : std::uint8_t {
    cartesian,  ///< vertical depths, hydrostatic along the vertical: water on gentle slopes
    bed_fitted  ///< depths along the normal of the bed, particles move on its surface: steep slopes
};

/// What drives the columns apart.
enum class Gradient : std::uint8_t {
    potential,  ///< the force of a potential energy: momentum on a plane and energy are kept
    level  ///< the gradient of the free surface, corrected: deep water over a steep, rough bed is driven by
           ///< its level alone; neither momentum nor energy are kept pair by pair
};

/// Coefficients of lateral earth pressure: S. B. Savage, K. Hutter, J. Fluid Mech. 199 (1989) 177. Between
/// the limits the coefficient K follows the strain, as that of an elastic body: K = active at the start, and
///
///     dK/dt = - stiffness div v,   active <= K <= passive.
///
/// A coefficient that jumps where div v changes its sign lets rounding errors throw columns about that rest.
struct EarthPressure {
    double active;                   ///< where the flow spreads [1]
    double passive;                  ///< where it is compressed [1]
    double mobilizing_strain = 0.2;  ///< that takes K from one limit to the other [1]

    double stiffness() const { return (passive - active) / mobilizing_strain; }
};

/// Choices and parameters of the depth-integrated model.
struct Settings {
    Form form = Form::cartesian;
    Gradient gradient = Gradient::potential;
    bool balance = false;                 ///< lakes released at a level stay at rest (docs/decisions/018)
    double gravity = 9.81;                ///< g [m/s2]
    double density = 1000;                ///< of the flow [kg/m3]
    double eta = 1.3;                     ///< smoothing length over (volume/height)^(1/D)
    double largest_smoothing_length = 0;  ///< cap, where columns fly apart [m]
    double merging_distance = 0;          ///< of columns that become one [m]; 0: none do
    double viscosity = 1;                 ///< of approaching columns, in terms of a Riemann problem's [1]
    bool curvature = true;                ///< of the bed, in the pressure on it; form = bed_fitted only
    std::optional<EarthPressure> earth_pressure{};  ///< none: hydrostatic
    std::optional<TwoPhase> two_phase{};            ///< none: one material
    double entrainment = 0;                         ///< E_s: growth of the volume for each metre of way [1/m]
    double courant = 0.4;                           ///< C in dt = C smoothing length / signal speed

    /// Range of the kernel in smoothing lengths.
    static constexpr double support() { return 2; }
};

}  // namespace talus::depth
