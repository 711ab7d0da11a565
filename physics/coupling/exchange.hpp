#pragma once
#include <optional>

#include "physics/coupling/drag.hpp"
#include "physics/coupling/history.hpp"
#include "physics/coupling/passes.hpp"

namespace talus::coupling {

/// What fluid and grains exert on each other.
struct ExchangeLaws {
    DragLaw drag = DiFelice{};
    PressureModel model = PressureModel::a;
    double viscosity = 0;  ///< of the fluid [Pa s]
    dem::Vector3<> gravity{};
    double virtual_mass = 0;                   ///< coefficient, 1/2 for a sphere; 0: none
    std::optional<HistoryKernel> basset = {};  ///< whether past changes of the slip act, and how long
    bool saffman = false, magnus = false;
    bool torque = false;                ///< whether the fluid slows the spin of grains
    bool feedback = true;               ///< whether the fluid feels the grains
    double least_fluid_fraction = 0.2;  ///< smaller ones are taken for this

    bool needs_vorticity() const { return saffman || magnus || torque; }
};

/// A grain as the exchange sees it.
struct MovingGrain {
    double radius, mass;  ///< [m], [kg]
    bool held;
    dem::Vector3<> velocity, spin;
    dem::Vector3<> other_acceleration;  ///< of gravity and contacts [m/s2]
    /// Mean over the step to come of the past changes of the slip u - v, each over the root of the time since
    /// [m/s^(3/2)].
    dem::Vector3<> remembered{};
};

/// Mean force of the fluid on a grain over the time step to come [N]. All but the drag are taken to last; the
/// drag acts on the velocity that it changes: with the coefficient beta of now, the grain's slip w relaxes as
/// that of two bodies, the grain with its virtual mass and the fluid's mass M at hand,
///
///     dw/dt = -beta (1/m + 1/M) w - A + a,
///
/// solved exactly, A and a being the accelerations of grain and fluid by all other forces. With M = V/sum_a
/// share_a (alpha_a/rhobar_a) any number of grains together take no more from the fluid than it has: kinetic
/// energy never grows, whatever the time step (docs/decisions/023).
///
/// Basset's force, 3/2 d^2 (pi rho mu)^(1/2) integral of dw/dt' (t - t')^(-1/2) dt', takes the slip to change
/// evenly within a step: the change to come then acts as a mass does, on that slip, and is part of what is
/// solved (docs/decisions/034).
dem::Vector3<> mean_force(const ExchangeLaws& laws, const MovingGrain& grain, const Gathered& fluid,
                          double wet_share, double time_step);

/// Angular velocity of a grain after the time step to come under the torque of the fluid alone,
/// -pi mu d^3 (omega - w/2) with the vorticity w, solved exactly: S. I. Rubinow, J. B. Keller, J. Fluid Mech.
/// 11 (1961) 447. The fluid does not feel it.
dem::Vector3<> relaxed_spin(const ExchangeLaws& laws, const MovingGrain& grain, const Gathered& fluid,
                            double wet_share, double time_step);

/// The drag coefficient that mean_force() takes [N s/m].
double drag_of(const ExchangeLaws& laws, const MovingGrain& grain, const Gathered& fluid, double wet_share);

}  // namespace talus::coupling
