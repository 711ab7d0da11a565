#include "physics/coupling/exchange.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "physics/coupling/lift.hpp"

namespace talus::coupling {

namespace {

/// (1 - exp(-z) - z)/z^2.
double lag_of_relaxation(double z) {
    constexpr double small = 1e-3;
    return z < small ? -0.5 + z * (1.0 / 6 + z * (-1.0 / 24 + z / 120)) : (-std::expm1(-z) - z) / (z * z);
}

double volume_of(const MovingGrain& grain) {
    return 4.0 / 3 * std::numbers::pi * grain.radius * grain.radius * grain.radius;
}

Surroundings surroundings(const ExchangeLaws& laws, const Gathered& fluid) {
    const double fraction = 1 - fluid.solid_fraction;
    return {.density = fluid.density / fraction,
            .viscosity = laws.viscosity,
            .fluid_fraction = std::max(fraction, laws.least_fluid_fraction)};
}

/// All forces of the fluid but drag and virtual mass.
dem::Vector3<> lasting_force(const ExchangeLaws& laws, const MovingGrain& grain, const Gathered& fluid,
                             const Surroundings& around, double wet_share) {
    const double volume = wet_share * volume_of(grain);
    dem::Vector3<> force = laws.model == PressureModel::a ? volume * fluid.force_density
                                                          : -(volume * around.density) * laws.gravity;
    if (!laws.saffman && !laws.magnus) return force;
    const ShearedSphere sheared{.density = around.density,
                                .viscosity = around.viscosity,
                                .diameter = 2 * grain.radius,
                                .slip = fluid.velocity - grain.velocity,
                                .vorticity = fluid.vorticity};
    if (laws.saffman) force += wet_share * saffman_mei_lift(sheared);
    if (laws.magnus) force += wet_share * magnus_lift(sheared, grain.spin);
    return force;
}

/// Basset's force for each integral of the slip's changes over the root of the time since [kg s^-1/2].
double basset_coefficient(const Surroundings& around, double diameter) {
    return 1.5 * diameter * diameter * std::sqrt(std::numbers::pi * around.density * around.viscosity);
}

}  // namespace

double drag_of(const ExchangeLaws& laws, const MovingGrain& grain, const Gathered& fluid, double wet_share) {
    return wet_share * drag_coefficient(laws.drag, laws.model, surroundings(laws, fluid), 2 * grain.radius,
                                        norm(fluid.velocity - grain.velocity));
}

dem::Vector3<> mean_force(const ExchangeLaws& laws, const MovingGrain& grain, const Gathered& fluid,
                          double wet_share, double time_step) {
    if (!(wet_share > 0)) return {};
    const Surroundings around = surroundings(laws, fluid);
    const dem::Vector3<> lasting = lasting_force(laws, grain, fluid, around, wet_share);
    const double volume = wet_share * volume_of(grain), beta = drag_of(laws, grain, fluid, wet_share);
    // One over the masses: a grain that is held has no end, nor has fluid that feels nothing.
    const double carried = laws.virtual_mass * around.density * volume;
    const double of_grain = grain.held ? 0.0 : 1 / (grain.mass + carried);
    const double of_fluid = laws.feedback ? fluid.crowding / volume : 0.0;
    const dem::Vector3<> others = of_grain * (grain.mass * grain.other_acceleration + lasting +
                                              carried * (fluid.acceleration + fluid.reaction));
    const double of_both = of_grain + of_fluid;
    const dem::Vector3<> slip = fluid.velocity - grain.velocity;
    dem::Vector3<> apart =
        others - (fluid.acceleration - of_fluid * lasting);  // without drag, slows the slip
    double slowed = 1;  // share of itself that the slip's rate of change keeps
    dem::Vector3<> earlier;
    double added = 0;
    if (laws.basset) {
        const double basset = wet_share * basset_coefficient(around, 2 * grain.radius);
        earlier = basset * grain.remembered;
        added = basset * HistoryKernel::added(time_step);
        slowed = 1 / (1 + added * of_both);
        apart = slowed * (apart + of_both * earlier);
    }
    dem::Vector3<> impulse;  // of drag and history
    const double rate = slowed * beta * of_both, z = rate * time_step;
    if (z > 0) {
        const double relaxed = -std::expm1(-z) / z;
        impulse = (beta * time_step) * (relaxed * slip + (lag_of_relaxation(z) * time_step) * apart);
    }
    if (laws.basset) {
        const dem::Vector3<> change = -time_step * apart - (slowed * of_both) * impulse;
        impulse += added * change + time_step * earlier;
    }
    if (grain.held)
        return lasting + carried * (fluid.acceleration + fluid.reaction) + (1 / time_step) * impulse;
    const dem::Vector3<> gained = time_step * others + of_grain * impulse;
    return (grain.mass / time_step) * gained - grain.mass * grain.other_acceleration;
}

dem::Vector3<> relaxed_spin(const ExchangeLaws& laws, const MovingGrain& grain, const Gathered& fluid,
                            double wet_share, double time_step) {
    const double diameter = 2 * grain.radius, inertia = 0.4 * grain.mass * grain.radius * grain.radius;
    const double rate =
        wet_share * std::numbers::pi * laws.viscosity * diameter * diameter * diameter / inertia;
    return grain.spin - std::expm1(-rate * time_step) * (0.5 * fluid.vorticity - grain.spin);
}

}  // namespace talus::coupling
