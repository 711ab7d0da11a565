#pragma once
#include <string>
#include <vector>

#include "comm/communicator.hpp"
#include "src/setup/grain_scene.hpp"

namespace talus {

/// What the time step makes of the impacts that a scene names.
struct ImpactFindings {
    std::vector<std::string> faults, warnings;
};

/// Hertz's contacts are the shorter and the stiffer the harder grains meet, of which the Rayleigh time knows
/// nothing. From the velocities at the start of bodies, sources and walls, and a fall from the highest grain
/// to the lowest:
/// - a head-on collision of the smallest grains of two bodies, or with a wall, must last six steps (a fault
///   if it does not at the velocities as they are) and should last ten: with fewer the restitution is off,
///   by 5 % of it at ten and by a seventh at six, if it is 0.5. Falls only warn.
/// - the smallest grain of a body that is caught between the largest of another, which brings the energy of
///   that speed, and something behind as hard must bear it (dem::PressedGrain), or a warning says so.
/// `grains`: as at the start. Nothing for linear laws, whose stiffness is the same at any speed, and in
/// sheared boxes, where velocities grow with the distance. Collective.
ImpactFindings find_hard_impacts(const Communicator& comm, const GrainScene& scene,
                                 const ParticleSet& grains);

}  // namespace talus
