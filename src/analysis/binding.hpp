#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "comm/communicator.hpp"
#include "src/analysis/fragments.hpp"
#include "src/setup/point.hpp"

namespace talus {

/// What is bound or not as a whole: a group of particles, or one particle of a group.
struct BindingUnit {
    std::uint64_t group;  ///< label of the group it is, or is part of
    double mass;          ///< [kg]
    Point centre;         ///< [m]
    Point velocity;       ///< [m/s]
};

struct BindingRules {
    double constant;        ///< of gravitation [m3 kg-1 s-2]
    std::size_t count;      ///< how many remnants are looked for
    int most_rounds = 200;  ///< of adding and dropping, for each remnant
};

/// What gravity holds together, around one seed.
struct BoundSet {
    std::uint64_t seed;       ///< label of the group it was looked for around
    double mass;              ///< [kg]
    std::uint64_t pieces;     ///< groups that have units in it
    int rounds;               ///< that it took
    std::uint64_t unsettled;  ///< units that were still joining or leaving in the last round allowed; 0: none
};

struct Binding {
    std::vector<BoundSet> sets;       ///< the heaviest first
    std::vector<std::size_t> set_of;  ///< of each unit of this rank; sets.size(): none
};

/// Which of the units of all ranks gravity holds together; the iteration of W. Benz, E. Asphaug, Icarus 142
/// (1999) 5, section 2.3, in which the remnant acts as a point mass at its centre of mass. The seed is the
/// heaviest group with no part in an earlier remnant. In each round every unit outside the earlier remnants
/// is set against the rest of this one, of mass M, by the energy of the two alone: with m its mass, r and v
/// distance and velocity between the centres of mass, it belongs to the remnant if v^2 r < 2 G (M + m). All
/// join and leave at once, until none does. A group that is one unit stays in the remnant that it is the seed
/// of. The search ends early where nothing is left of a seed or no seed is left. `groups`: all of them, on
/// every rank, the heaviest first. The same on any number of ranks. Collective.
Binding find_bound(const Communicator& comm, std::span<const BindingUnit> units,
                   std::span<const Fragment> groups, const BindingRules& rules);

}  // namespace talus
