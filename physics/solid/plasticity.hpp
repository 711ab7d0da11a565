#pragma once
#include <cstdint>
#include <span>
#include <variant>

#include "physics/solid/stress_state.hpp"

namespace talus {

/// Mean pressure p (compression positive) and the size of the deviator, tau = sqrt(J2) [Pa].
struct Invariants {
    double pressure, shear;
};

/// A cone in the plane of invariants: tau <= cohesion + friction p, flow with dilation: volume per shear
/// strain.
struct Cone {
    double friction = 0;  ///< slope of the cone [1]
    double cohesion = 0;  ///< tau at p = 0 [Pa]
    double dilation =
        0;  ///< plastic volume strain over plastic shear strain lambda = integral of 2 sqrt(J2(e)) [1]
};

/// How a cone is laid along the pyramid of Mohr and Coulomb.
enum class ConeMatch : std::uint8_t {
    plane_strain,  ///< exact where plane strain flows, for any dilation angle
    compression,   ///< through the edges of triaxial compression (outer cone)
    extension,     ///< through those of triaxial extension (inner cone)
};

/// The cone for cohesion c [Pa], friction angle and dilation angle [rad]. Compression and extension: O. C.
/// Zienkiewicz, R. L. Taylor, The Finite Element Method 2 (2000), section 3.5. Plane strain: the flow rule
/// without strain across fixes s_zz = -2 tau b, b = dilation/3, so that Coulomb's law in the plane reads tau
/// (sqrt(1 - 3 b^2) + b sin phi) = c cos phi + p sin phi; for psi = phi the cone of D. C. Drucker, W. Prager,
/// Q. Appl. Math. 10 (1952) 157, for psi = 0 tau = c cos phi + p sin phi.
Cone cone(ConeMatch match, double cohesion, double friction_angle, double dilation_angle);
/// The same from the tangents of the angles.
Cone cone_of_slopes(ConeMatch match, double cohesion, double friction_slope, double dilation_slope);

// What becomes of gaps that open under tension beyond the strength, `forgets_gaps`. True: matter keeps the
// density at which it opened, as the return to an apex does, and bears pressure as soon as it is compressed
// again. False: its density falls as it is stretched, and its gaps must close first.

/// Elastic, then perfectly plastic or softening within a cone of Drucker and Prager, flowing along a cone of
/// its own (not associated), and cut off in tension.
struct DruckerPrager {
    Cone peak, residual;  ///< of matter that has not yet flowed, and that has for long
    double softening_strain =
        0;  ///< plastic shear strain from the first to the second [1]; 0: the peak for ever
    double tensile_strength = 0;  ///< greatest mean tension [Pa]; never more than the cone bears
    bool forgets_gaps = true;     ///< as said above

    bool softens() const { return softening_strain > 0; }
    bool keeps_volume_strain() const { return peak.dilation > 0 || residual.dilation > 0; }
    /// The cone after a plastic shear strain, linear between the two.
    Cone cone_at(double plastic_shear_strain) const {
        if (!softens()) return peak;
        const double w = std::min(plastic_shear_strain / softening_strain, 1.0);
        return {(1 - w) * peak.friction + w * residual.friction,
                (1 - w) * peak.cohesion + w * residual.cohesion,
                (1 - w) * peak.dilation + w * residual.dilation};
    }
};

/// Dense granular flow: tau = mu(I) p, mu = mu_s + (mu_2 - mu_s)/(I0/I + 1), I = rate d sqrt(rho_g/p), rate =
/// 2 sqrt(J2(e)): P. Jop, Y. Forterre, O. Pouliquen, Nature 441 (2006) 727. Elastic below mu_s p, without
/// pressure where it is stretched. The elastic part is what keeps it well posed at small rates. S. Dunatunga,
/// K. Kamrin, J. Fluid Mech. 779 (2015) 483.
struct GranularFlow {
    double friction_static;    ///< mu_s, of slow flow [1]
    double friction_limit;     ///< mu_2, of fast flow [1]
    double inertial_number;    ///< I0 [1]
    double grain_diameter;     ///< d [m]
    double grain_density;      ///< rho_g [kg/m3]
    bool forgets_gaps = true;  ///< as said above

    static constexpr bool softens() { return false; }
    static constexpr bool keeps_volume_strain() { return false; }
};

using Plasticity = std::variant<DruckerPrager, GranularFlow>;

/// Constants of Hooke's law [Pa], and the density at which the pressure is zero [kg/m3].
struct Elasticity {
    double bulk_modulus, shear_modulus, reference_density;
};

/// Where a trial state comes to lie, and what flowed on the way.
struct Returned {
    Invariants state;
    double volume_strain = 0, shear_strain = 0;  ///< plastic, added [1]
    double gap = 0;                              ///< volume strain by which it opened [1]
};

/// Return of an elastic trial state to the yield surface. Drucker-Prager: along the flow in one step, exact
/// for constant cones: tau - G lambda, p + (K + p) dilation lambda, lambda = f/(G + (K + p) friction
/// dilation); behind the apex or the cut-off of tension to it. `strain`: plastic shear strain before.
/// Granular flow: the implicit step in closed form (Dunatunga & Kamrin 2015, eq. 4.6), the trial being that
/// of the last `elapsed` seconds.
Returned returned(const DruckerPrager& model, const Elasticity& elastic, const Invariants& trial,
                  double strain);
Returned returned(const GranularFlow& model, const Elasticity& elastic, const Invariants& trial,
                  double elapsed);

/// The columns of one predicted or stored state, one value a particle. `volume_strain`, `shear_strain`:
/// plastic, empty if the model keeps none.
struct PlasticState {
    std::span<double> density;     ///< [kg/m3]
    StressColumns<double> stress;  ///< deviatoric [Pa]
    std::span<double> volume_strain, shear_strain;
};

/// Returns the stress of all particles with body == which, in place. The pressure of the trial is K (rho
/// exp(plastic volume strain)/rho0 - 1); where it ends is written to `pressure` if that is not empty, and the
/// density follows if gaps are forgotten. `keep_strains`: what flowed is added to the plastic strains; they
/// are read only otherwise.
void return_stress(const Plasticity& model, const Elasticity& elastic, const PlasticState& state,
                   double elapsed, bool keep_strains, std::span<double> pressure,
                   std::span<const std::uint8_t> body, std::uint8_t which);

}  // namespace talus
