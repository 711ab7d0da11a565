#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "comm/communicator.hpp"
#include "domain/box.hpp"
#include "domain/particles.hpp"

namespace talus {

/// What holds together: particles of one body with damage below a threshold, linked when closer than a
/// linking length (W. Benz, E. Asphaug, Icarus 107 (1994) 98, take all particles with D < 1); or all matter
/// that touches, whatever its damage and body.
struct FragmentRules {
    double damage_threshold = 1;
    std::vector<double> linking_length;  ///< one a body [m]; 0: the body is not looked at
    bool all_matter = false;  ///< damaged particles, too, and across bodies: the larger length counts

    bool operator==(const FragmentRules&) const = default;
};

/// Whether own particle `i` can belong to a fragment.
bool may_link(const ParticleSet& particles, const FragmentRules& rules, std::size_t i);

/// One connected piece.
struct Fragment {
    std::uint64_t label;             ///< smallest id of its particles
    std::uint8_t body;               ///< index of the body it is a piece of, the least one of several
    std::uint64_t particles;         ///< how many
    double mass;                     ///< [kg]
    std::array<double, 3> centre;    ///< centre of mass [m], of the particles themselves in a periodic box
    std::array<double, 3> velocity;  ///< of the centre of mass [m/s]
};

/// The particles looked at, on other ranks than before, and the fragments they form.
struct LinkedParticles {
    ParticleSet particles;  ///< velocity, mass, body, fragment (the label); damage, smoothing_length if known
    std::vector<Fragment> fragments;  ///< of all ranks on every rank
};

/// All fragments of all ranks on every rank, the heaviest first, equally heavy ones in order of label: the
/// same bits on any number of ranks. `particles` need a body, mass and velocity, and damage if they have any;
/// they are left as they are. Collective.
///
/// Each rank joins what is linked among its own particles and copies, then takes the smallest label of each
/// piece, and labels travel with the halo until no rank learns a smaller one: as many rounds as the most
/// winding fragment crosses borders of ranks.
LinkedParticles link_particles(const Communicator& comm, const Box& box, const ParticleSet& particles,
                               const FragmentRules& rules);
std::vector<Fragment> find_fragments(const Communicator& comm, const Box& box, const ParticleSet& particles,
                                     const FragmentRules& rules);

}  // namespace talus
