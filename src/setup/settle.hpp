#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/scene.hpp"
#include "src/setup/bodies.hpp"
#include "src/simulation.hpp"

namespace talus {

struct SceneSetup;

/// How bodies come to rest in their own gravity before time 0; the scene's [settle] table (docs/scene.md).
struct SettlePlan {
    double imbalance = 0;                 ///< rms acceleration over that of gravity alone, at most [1]
    std::optional<double> largest_speed;  ///< of any particle, at most [m/s]
    std::optional<double> damping;        ///< time in which damping alone divides speeds by e [s]
    std::optional<double> longest;        ///< time that a body may take [s]
    std::vector<bool> bodies;             ///< which, one a body
};

/// Reads [settle], if there is one; `census`: of the bodies. Faults are recorded in the scene.
std::optional<SettlePlan> read_settle(const Section& root, const std::vector<Body>& bodies,
                                      const std::vector<BodyCensus>& census, const Setup& simulation);

/// How the settling of one body went.
struct Settling {
    std::string body;
    double time = 0;  ///< that it took [s]
    std::uint64_t steps = 0;
    double damping = 0;            ///< time of it [s]
    double quiet_for = 0;          ///< time that quiet had to last, that of sound through the body [s]
    double imbalance = 0;          ///< rms acceleration over that of gravity alone [1]
    double largest_speed = 0;      ///< [m/s]
    double kinetic_share = 0;      ///< kinetic energy over that of gravity, without its sign [1]
    double growth = 0;             ///< relative change of the rms distance from the centre of mass [1]
    double greatest_pressure = 0;  ///< [Pa]
};

std::string describe(const Settling& settling);

/// Lets the bodies that the plan names come to rest, one after the other, each without the others, its own
/// motion and its spin, as a fluid of its equation of state: shear stress stays zero and damage as it is.
/// Velocities are damped as exp(-t/damping). It is over once forces balance and speeds are small all the time
/// that sound needs to pass through the body. Then `particles`, those of time 0, have the positions,
/// densities, energies and smoothing lengths that came out, about the centre of mass from before, and move as
/// the scene says. The same bits on any number of ranks. `before_step` (collective) is called before each
/// step and may throw. Throws AgreedError (exit code 1) if a body does not settle. Collective.
std::vector<Settling> settle(const Communicator& comm, const SceneSetup& scene, ParticleSet& particles,
                             const std::function<void()>& before_step);

}  // namespace talus
