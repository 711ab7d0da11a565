#pragma once
#include <array>
#include <limits>

#include "physics/dem/laws/kinematics.hpp"

namespace talus::dem {

/// What joins two grains.
struct BondMaterial {
    double youngs_modulus;                                              ///< E [Pa]
    double poisson_ratio;                                               ///< nu [1]
    double tensile_strength = std::numeric_limits<double>::infinity();  ///< [Pa]
    double shear_strength = std::numeric_limits<double>::infinity();    ///< [Pa]
    double damping_ratio = 0;                                           ///< of each spring, 1 is critical [1]
    bool shear_compliance = true;  ///< Timoshenko's beam, else Euler-Bernoulli's
};

/// Motion of a bonded pair as its first side sees it.
struct BondKinematics {
    double length;       ///< distance of the centres [m]
    Vector3<> normal;    ///< unit vector from the second to the first
    Vector3<> velocity;  ///< of the first relative to the second, both taken to the middle as if rigid [m/s]
    Vector3<> angular_velocity;         ///< of the first relative to the second [rad/s]
    Vector3<> summed_angular_velocity;  ///< [rad/s]
    double effective_mass;              ///< [kg]
    double effective_inertia;           ///< I_1 I_2/(I_1 + I_2), about the centres [kg m2]
    double time_step;                   ///< [s]
};
/// `separation` from the second centre to the first; inertias about the centres [kg m2].
BondKinematics bond_kinematics(const Vector3<>& separation, const Grain<double>& first, double first_inertia,
                               const Grain<double>& second, double second_inertia, double time_step);

/// What a bond answers: load on the first grain at the middle of the bond (torque_about_centre with half the
/// length as arm), the negative on the second; and the greatest stresses at its ends.
struct BondResponse {
    ContactLoad<double> load;
    double tensile_stress;  ///< of tension and bending, negative under compression alone [Pa]
    double shear_stress;    ///< of shear and torsion [Pa]
};

/// A round beam between the centres of two grains, without mass: axial spring EA/L, torsion GJ/L, bending
/// EI/L and shear 12 EI/(L^3 (1 + Phi)) at the middle, which together are the stiffness matrix of
/// Timoshenko's beam, Phi = 12 EI/(kappa G A L^2), kappa = 6 (1 + nu)/(7 + 6 nu); Phi = 0 for Euler's and
/// Bernoulli's. N. J. Brown, J.-F. Chen, J. Y. Ooi, Granular Matter 16 (2014) 299; X. Chen, L. G. Wang, N. J.
/// Brown, J. Y. Ooi, Granular Matter 24 (2022) 29. Greatest stresses after D. O. Potyondy, P. A. Cundall,
/// Int. J. Rock Mech. Min. Sci. 41 (2004) 1329, eqs 17-18.
class BeamBond {
  public:
    /// Shear displacement (3) [m], bending angle (3) and twist [rad], as the first side sees them; zero in a
    /// new bond.
    static constexpr std::size_t history_count = 7;
    using History = std::array<double, history_count>;

    /// `radius` of the beam's section and `length` at rest [m], both positive.
    BeamBond(const BondMaterial& material, double radius, double length);

    /// Advances the history by the time step.
    BondResponse operator()(const BondKinematics& k, History& history) const;

    bool breaks(const BondResponse& response) const {
        return response.tensile_stress > material_.tensile_strength ||
               response.shear_stress > material_.shear_strength;
    }

    /// Greatest stable step of the leapfrog for two grains of this mass and inertia joined by many such bonds
    /// each [s].
    double stable_step(double mass, double inertia, int bonds_of_a_grain) const;

  private:
    BondMaterial material_;
    double length_, radius_, area_, inertia_of_area_;
    double axial_, shear_, bending_, torsion_;  // stiffnesses [N/m], [N/m], [N m], [N m]
};

}  // namespace talus::dem
