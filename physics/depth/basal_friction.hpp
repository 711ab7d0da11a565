#pragma once
#include <algorithm>
#include <cmath>
#include <variant>

#include "physics/depth/viscoplastic_profile.hpp"

/// Resistance of the bed to a depth-integrated flow. Every law gives, for a column of the flow,
///
///     stress(speed, column)                  shear stress at the bed [Pa], growing with the speed
///     speed_after(speed, time_step, column)  speed [m/s] after the bed alone has acted for a time step
///
/// The second is the implicit Euler step of rho h ds/dt = -stress(s): for any time step it lies between zero
/// and the speed before, and it is zero, exactly, once the stress that a law has at rest suffices to stop the
/// flow within the step. What drives the flow acts before: then a flow at rest on a bed that can hold it
/// stays at rest.
namespace talus::depth {

/// What laws of the bed look at: a column of the flow.
struct Column {
    double depth;              ///< h, along the direction that mass is integrated in [m]
    double density;            ///< rho [kg/m3]
    double normal_stress;      ///< total, at the bed [Pa]
    double pore_pressure = 0;  ///< at the bed [Pa]
    double gravity = 9.81;     ///< g [m/s2]

    double mass() const { return density * depth; }  ///< [kg/m2]
    double effective_stress() const { return std::max(normal_stress - pore_pressure, 0.0); }
};

/// Solution s of s + constant + factor s^2 = speed, 0 if there is none above.
inline double speed_after_quadratic(double speed, double constant, double factor) {
    const double left = speed - constant;
    if (!(left > 0)) return 0;
    return 2 * left / (1 + std::sqrt(1 + 4 * factor * left));
}

/// No resistance.
struct Frictionless {
    double stress(double, const Column&) const { return 0; }
    double speed_after(double speed, double, const Column&) const { return speed; }
};

/// c + (sigma_n - p) tan(phi), whatever the speed. S. B. Savage, K. Hutter, J. Fluid Mech. 199 (1989) 177.
struct Coulomb {
    double friction;      ///< tan(phi) [1]
    double cohesion = 0;  ///< c [Pa]

    double stress(double, const Column& column) const {
        return cohesion + column.effective_stress() * friction;
    }
    double speed_after(double speed, double time_step, const Column& column) const {
        return speed_after_quadratic(speed, time_step * stress(speed, column) / column.mass(), 0);
    }
};

/// mu (sigma_n - p) + rho g s^2 / xi. A. Voellmy, Schweiz. Bauzeitung 73 (1955) 159; B. Salm, Ann. Glaciol.
/// 18 (1993) 221.
struct Voellmy {
    double friction;    ///< mu [1]
    double turbulence;  ///< xi [m/s2]

    double stress(double speed, const Column& column) const {
        return friction * column.effective_stress() +
               column.density * column.gravity * speed * speed / turbulence;
    }
    double speed_after(double speed, double time_step, const Column& column) const {
        return speed_after_quadratic(speed, time_step * friction * column.effective_stress() / column.mass(),
                                     time_step * column.gravity / (turbulence * column.depth));
    }
};

/// rho g n^2 s^2 / h^(1/3): water over a rough bed. R. Manning, Trans. Inst. Civ. Eng. Ireland 20 (1891) 161.
struct Manning {
    double roughness;  ///< n [s/m^(1/3)], 1 over Strickler's coefficient

    double stress(double speed, const Column& column) const {
        return column.density * column.gravity * roughness * roughness * speed * speed /
               std::cbrt(column.depth);
    }
    double speed_after(double speed, double time_step, const Column& column) const {
        return speed_after_quadratic(
            speed, 0,
            time_step * column.gravity * roughness * roughness / (column.depth * std::cbrt(column.depth)));
    }
};

/// rho g s^2 / C^2: water over a rough bed; V. T. Chow, Open-Channel Hydraulics (1959), section 5-4.
struct Chezy {
    double coefficient;  ///< C [m^(1/2)/s]

    double stress(double speed, const Column& column) const {
        return column.density * column.gravity * speed * speed / (coefficient * coefficient);
    }
    double speed_after(double speed, double time_step, const Column& column) const {
        return speed_after_quadratic(speed, 0,
                                     time_step * column.gravity / (coefficient * coefficient * column.depth));
    }
};

/// 3 mu s / h: laminar flow with a parabolic profile.
struct Newtonian {
    double viscosity;  ///< mu [Pa s]

    double stress(double speed, const Column& column) const { return 3 * viscosity * speed / column.depth; }
    double speed_after(double speed, double time_step, const Column& column) const {
        return speed / (1 + time_step * 3 * viscosity / (column.mass() * column.depth));
    }
};

/// Laws that come from a profile of the shear rate over the depth: `Law` says which, and the stress that the
/// bed bears beside it.
template <class Law>
struct FromProfile {
    double stress(double speed, const Column& column) const {
        if (!(column.depth > 0)) return law().friction_at_rest(column) + law().profile().yield_stress;
        return law().friction_at_rest(column) + law().profile().yield_stress +
               law().profile().excess(speed, 0, column.depth);
    }
    double speed_after(double speed, double time_step, const Column& column) const {
        if (!(column.depth > 0)) return 0;
        const ViscoplasticProfile profile = law().profile();
        const double per_stress = time_step / column.mass();
        const double left = speed - per_stress * (law().friction_at_rest(column) + profile.yield_stress);
        if (!(left > 0)) return 0;
        return std::min(profile.mean_speed(profile.excess(left, per_stress, column.depth), column.depth),
                        left);
    }

  private:
    const Law& law() const { return static_cast<const Law&>(*this); }
};

/// Stress tau_y + mu times the shear rate where the flow shears. P. Coussot, Mudflow Rheology and Dynamics
/// (1997).
struct Bingham : FromProfile<Bingham> {
    double yield_stress;  ///< tau_y [Pa]
    double viscosity;     ///< mu [Pa s]

    Bingham(double yield_stress_, double viscosity_) : yield_stress(yield_stress_), viscosity(viscosity_) {}
    ViscoplasticProfile profile() const { return {yield_stress, viscosity, 1}; }
    double friction_at_rest(const Column&) const { return 0; }
};

/// Stress tau_y + K times the n-th power of the shear rate. W. H. Herschel, R. Bulkley, Kolloid-Z. 39 (1926)
/// 291.
struct HerschelBulkley : FromProfile<HerschelBulkley> {
    double yield_stress;  ///< tau_y [Pa]
    double consistency;   ///< K [Pa s^n]
    double exponent;      ///< n [1]

    HerschelBulkley(double yield_stress_, double consistency_, double exponent_)
        : yield_stress(yield_stress_), consistency(consistency_), exponent(exponent_) {}
    ViscoplasticProfile profile() const {
        return {yield_stress, std::pow(consistency, 1 / exponent), 1 / exponent};
    }
    double friction_at_rest(const Column&) const { return 0; }
};

/// Perzyna's viscoplasticity in simple shear: shear rate gamma ((tau - s)/s_0)^N above the strength
/// s = c + (sigma - p) tan(phi), where sigma and p fall linearly from the bed to the surface.
/// P. Perzyna, Adv. Appl. Mech. 9 (1966) 243; M. Pastor et al., Arch. Comput. Methods Eng. 22 (2015)
/// 67, use it in depth-integrated models. The friction is then the same share of the stress at every
/// height, so that the rest is the profile of a Herschel-Bulkley fluid.
struct PerzynaViscoplastic : FromProfile<PerzynaViscoplastic> {
    double cohesion;          ///< c [Pa]
    double friction;          ///< tan(phi) [1]
    double fluidity;          ///< gamma [1/s]
    double reference_stress;  ///< s_0 [Pa]
    double exponent;          ///< N [1]

    PerzynaViscoplastic(double cohesion_, double friction_, double fluidity_, double reference_stress_,
                        double exponent_)
        : cohesion(cohesion_),
          friction(friction_),
          fluidity(fluidity_),
          reference_stress(reference_stress_),
          exponent(exponent_) {}
    ViscoplasticProfile profile() const {
        return {cohesion, std::pow(reference_stress, exponent) / fluidity, exponent};
    }
    double friction_at_rest(const Column& column) const { return column.effective_stress() * friction; }
};

/// What a scene may choose from.
using BasalFriction = std::variant<Frictionless, Coulomb, Voellmy, Manning, Chezy, Newtonian, Bingham,
                                   HerschelBulkley, PerzynaViscoplastic>;

}  // namespace talus::depth
