#pragma once
#include <array>
#include <vector>

#include "domain/particles.hpp"
#include "physics/sph/settings.hpp"

namespace talus::sph {

/// Leapfrog, kick-drift-kick: the state lives in velocity, internal_energy, density and deviatoric_stress;
/// the pair loops see it predicted to the time of evaluation (predicted_* fields). Energy is changed so that
/// the kinetic and internal energies together gain exactly `specific_power * time`, the work of antisymmetric
/// pair forces, which sums to zero over all particles: total energy is conserved to rounding. Fields that a
/// set does not have (density when summed, stress in fluids) are left out.

/// What differs from body to body, one each.
struct BodyConstants {
    std::vector<double> shear_modulus;           ///< [Pa]
    std::vector<std::array<double, 3>> gravity;  ///< acceleration, the same everywhere [m/s2]; empty: none
};

/// Moves the state `time` forward with the rates of the last evaluation.
void kick(ParticleSet& particles, const BodyConstants& bodies, const Settings& settings, double time);

/// Positions: x += v time.
void drift(ParticleSet& particles, double time);

/// Fills the predicted fields with the state moved `time` forward by the rates of the last evaluation.
void predict(ParticleSet& particles, const BodyConstants& bodies, const Settings& settings, double time);

/// What limits the time step, for messages.
struct StepLimit {
    double time_step;  ///< [s]
    std::uint64_t id;  ///< of the particle that sets it
    const char* reason;
};

/// Longest stable step over the own particles: Courant's criterion with the longitudinal elastic sound speed,
/// dt = C h/(c_l + 0.6 max(alpha c - 2 beta mu) + h |div v|), the second term (standard SPH only) from the
/// slope of the viscosity over approaching partners, and the acceleration's, dt = C sqrt(h/|a|). J. J.
/// Monaghan, Annu. Rev. Astron. Astrophys. 30 (1992) 543, section 10.3.
StepLimit stable_time_step(const ParticleSet& particles, const BodyConstants& bodies,
                           const Settings& settings);

}  // namespace talus::sph
