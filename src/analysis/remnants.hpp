#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "comm/communicator.hpp"
#include "domain/box.hpp"
#include "domain/particles.hpp"
#include "src/analysis/binding.hpp"
#include "src/analysis/fragments.hpp"

namespace talus {

/// What is looked for by gravitational binding.
struct RemnantRules {
    BindingRules binding;
    bool particles_bind = false;  ///< each particle by itself; else each group as a whole
    FragmentRules groups;         ///< all matter that touches
    std::vector<double> spacing;  ///< of the particles of each body: D-th root of their volume [m]
};

/// Sums over some particles.
struct MatterFigures {
    std::uint64_t particles = 0;
    double mass = 0;                      ///< [kg]
    Point centre{}, velocity{};           ///< of mass [m], [m/s]
    Point angular_momentum{};             ///< about the centre of mass [kg m2/s]
    std::optional<double> mean_damage;    ///< by mass
    std::optional<double> fully_damaged;  ///< share of the mass with D = 1
};

/// Shape and spin of a body, each particle a cube of its volume.
struct BodyFigures {
    std::array<Point, 3> axes{};  ///< principal axes, the longest first, right-handed unit vectors
    Point semi_axes{};            ///< of the ellipsoid with the same mass and inertia [m], falling
    Point extents{};              ///< from end to end along each principal axis [m]
    double density = 0;           ///< mass over volume of that ellipsoid [kg/m3]
    Point spin{};                 ///< inverse inertia tensor times angular momentum [rad/s]
};

/// All that gravity holds together, and the heaviest connected body of it.
struct Remnant {
    BoundSet set;
    MatterFigures bound;
    MatterFigures body;
    BodyFigures shape;
};

struct Remnants {
    double mass = 0;            ///< of all matter looked at [kg]
    std::vector<Remnant> list;  ///< the heaviest first
    ParticleSet bound;          ///< the particles of them, field remnant counting from 1: "remnants"
};

/// Collective. The same bits on any number of ranks. `linked` is that of rules.groups.
Remnants find_remnants(const Communicator& comm, const LinkedParticles& linked, const RemnantRules& rules);

/// The sums over the own particles `chosen` on every rank. Collective.
MatterFigures figures_of(const Communicator& comm, const ParticleSet& particles,
                         std::span<const std::uint32_t> chosen);
/// Shape and spin of them. `spacing`: one a body. Collective.
BodyFigures shape_of(const Communicator& comm, const ParticleSet& particles,
                     std::span<const std::uint32_t> chosen, const MatterFigures& figures,
                     std::span<const double> spacing);

}  // namespace talus
