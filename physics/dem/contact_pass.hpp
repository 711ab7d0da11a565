#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "physics/dem/contact_list.hpp"
#include "physics/dem/force_sum.hpp"
#include "physics/dem/grain_rows.hpp"
#include "physics/dem/law_table.hpp"

namespace talus::dem {

/// Which pairs of a list a loop visits: those of own grains can be worked on while copies are on their way.
enum class Pairs : std::uint8_t { own, with_copies };

/// What all contacts of one evaluation have in common.
struct Evaluation {
    const GrainRows& rows;
    double time_step;          ///< that histories advance by [s]
    double approach;           ///< no two grains have come nearer by more since the pairs were listed [m]
    std::span<ForceSum> sums;  ///< of the own grains, and one behind for all others
    double largest_radius;     ///< [m]
    /// Makes the rows and sums of the own grains below `end` ready, if they are not yet. Pairs of own grains
    /// ask for it just before they reach for these, so that what is made ready is still in the cache.
    std::function<void(std::size_t end)> make_ready;
};

/// A contact whose force is not finite or beyond what its grains could bear pressed flat.
struct Overload {
    bool found = false;
    std::uint32_t first = 0, second = 0;  ///< grains as stored, or a grain and a wall
    bool behind = false;                  ///< the grain's centre is behind the wall's surface
};

/// What contacts of these laws remember, in the order of their records.
std::vector<const FieldInfo*> history_fields(const AnyLawTable& laws);

/// Greatest gap across which any pair of grains up to a radius may act [m].
double greatest_reach(const AnyLawTable& laws, double largest_radius);

/// evaluate_pairs() for laws of these two parts.
template <class Elasticity, class SurfaceForce>
Overload evaluate_family(const Evaluation& evaluation, const AnyLawTable& laws, Pairs which,
                         ContactList& list);

/// Finds the pairs that touch and adds their forces to both sides, as far as those are own grains. A pair
/// with a copy is computed by both ranks, with the same bits. Contacts that did not touch at the last
/// evaluation begin anew. Pairs of own grains come first, then those with copies.
Overload evaluate_pairs(const Evaluation& evaluation, const AnyLawTable& laws, Pairs which,
                        ContactList& list);

}  // namespace talus::dem
