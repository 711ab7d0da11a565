#pragma once
#include "domain/particles.hpp"
#include "physics/sph/motion.hpp"
#include "physics/water/settings.hpp"

namespace talus::water {

/// Moves velocity and density `time` forward with the rates of the last evaluation.
void kick(ParticleSet& particles, double time);

/// Places move on with shift_velocity, if the set has it.
void shift(ParticleSet& particles, double time);

/// Longest stable step over the own particles: by sound, dt = C h/(c + 0.6 alpha c0 + h |drho/dt|/rho) (J. J.
/// Monaghan, Annu. Rev. Astron. Astrophys. 30 (1992) 543, section 10.3); by viscosity, dt = 0.125 h^2
/// rho/mu, mu the greatest that a rheology has; and by acceleration, dt = 0.25
/// sqrt(h/|a|) (J. P. Morris et al., J. Comput. Phys. 136 (1997) 214, eqs 25-27).
sph::StepLimit stable_time_step(const ParticleSet& particles, const Settings& settings);

}  // namespace talus::water
