#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "comm/communicator.hpp"
#include "domain/particles.hpp"
#include "io/scene.hpp"
#include "src/analysis/fragments.hpp"
#include "src/setup/bodies.hpp"
#include "src/simulation.hpp"

namespace talus {

/// When and how what is left of the bodies becomes grains; the scene's [hand_off] table (docs/scene.md).
struct HandOffPlan {
    double at = 0;                        ///< [s]
    std::optional<FragmentRules> groups;  ///< whose particles become one grain; none: no particles do
    double filling = 1;                   ///< volume of a grain over that of its matter [1]
    std::vector<double> density;          ///< of the matter, one a body [kg/m3]
};

/// Reads [hand_off], if there is one. `end_time` [s] is that of the run. Faults are recorded in the scene.
std::optional<HandOffPlan> read_hand_off(const Section& root, const std::vector<Body>& bodies,
                                         const Setup& setup, double end_time);

/// What particles or grains add up to.
struct Ledger {
    double mass = 0;            ///< [kg]
    Point momentum{};           ///< [kg m/s]
    Point angular_momentum{};   ///< about the origin, spin included [kg m2/s]
    double momentum_size = 0;   ///< sum of the sizes [kg m/s]
    double turning_size = 0;    ///< sum of the sizes of what makes up the angular momentum [kg m2/s]
    double kinetic_energy = 0;  ///< spin included [J]
};

/// Pairs of grains closer than the sum of their radii.
struct Overlaps {
    std::uint64_t pairs = 0;
    double deepest = 0;  ///< largest sum of radii less distance [m]
    double share = 0;    ///< largest of the same over the smaller radius [1]
};

struct HandOff {
    ParticleSet grains;           ///< "grains": each rank some of them
    std::uint64_t particles = 0;  ///< that became grains
    std::uint64_t fragments = 0;  ///< grains of several particles
    std::uint64_t singles = 0;    ///< grains of one
    Ledger before{}, after{};
    double internal_energy = 0;  ///< of the particles, which grains do not have [J]
    Overlaps overlaps{};
};

/// Makes one spherical grain of each group, and one of each particle of no group; in three dimensions. A
/// grain has the mass of its particles (sums are exact), their centre of mass and its velocity, as id the
/// smallest of theirs, as body the least. Its volume is `filling` times the sum of mass over density of the
/// body; its angular velocity is such that an even sphere, 2/5 m R^2, has the angular momentum of the
/// particles about the centre of mass. Grains are not moved apart where they overlap. The same bits on any
/// number of ranks. Collective.
HandOff hand_off(const Communicator& comm, const HandOffPlan& plan, const Box& box,
                 const ParticleSet& particles);

/// The exact sums over particles or grains, the latter with their spin. Collective.
Ledger ledger_of(const Communicator& comm, const ParticleSet& particles);

/// Which pairs count.
enum class Between : std::uint8_t { all, different_bodies };

/// Collective.
Overlaps overlaps_of(const Communicator& comm, const ParticleSet& grains, Between which = Between::all);

/// In words, for the log.
std::string describe(const HandOff& result);

}  // namespace talus
