#pragma once
#include <array>
#include <cmath>
#include <cstddef>

#include "physics/dem/laws/elasticity.hpp"
#include "physics/dem/laws/friction.hpp"
#include "physics/dem/laws/no_resistance.hpp"
#include "physics/dem/laws/rolling.hpp"
#include "physics/dem/laws/surface_force.hpp"
#include "physics/dem/laws/twisting.hpp"

namespace talus::dem {

/// A contact law: its parts with the coefficients of one pair of materials. All members of all parts are of
/// the type Real, so that laws of doubles can be gathered to a law of lanes (pair_table.hpp).
///
/// History: `history_count` values a contact, zero when a contact begins and set to zero when it has ended:
/// the displacements of friction, rolling and twisting, in this order, as the first side sees them, and 1
/// while a contact lasts if the elasticity makes a difference of that.
template <class Real_, class Elasticity, class Friction, class Rolling, class Twisting, class SurfaceForce>
struct ContactLaw {
    using Real = Real_;
    Elasticity elasticity;
    [[no_unique_address]] Friction friction;
    [[no_unique_address]] Rolling rolling;
    [[no_unique_address]] Twisting twisting;
    [[no_unique_address]] SurfaceForce surface_force;

    static constexpr std::size_t vectors_count = Friction::history_count + Rolling::history_count,
                                 displacements_count = vectors_count + Twisting::history_count,
                                 history_count = displacements_count + (Elasticity::sticks ? 1 : 0);
    static constexpr bool slides = Friction::history_count > 0, rolls = Rolling::history_count > 0,
                          twists = Twisting::history_count > 0, sticks = Elasticity::sticks;
    using History = std::array<Real, history_count>;

    /// Force and couple on the first side; advances the history by the time step. Zero, with a history of
    /// zeros, if the pair does not touch and is out of reach.
    ContactLoad<Real> operator()(const ContactKinematics<Real>& k, History& history) const {
        Real touched(0.0);
        if constexpr (Elasticity::sticks) touched = history.back();
        const ElasticResponse<Real> elastic = elasticity(k, touched);
        const Real repulsion = select(elastic.touching, elastic.normal_force, Real(0.0));
        const Real load = select(elastic.touching, elastic.friction_load, Real(0.0));
        Real* const stored = history.data();
        ContactLoad<Real> result;
        result.force = (repulsion - surface_force(k)) * k.normal + friction(k, elastic, load, stored);
        result.couple = rolling(k, elastic, load, stored + Friction::history_count) +
                        twisting(k, elastic, load, stored + vectors_count);
        for (Real& value : history) value = select(elastic.touching, value, Real(0.0));
        if constexpr (Elasticity::sticks) history.back() = select(elastic.touching, Real(1.0), Real(0.0));
        return result;
    }

    /// The history as the second side sees it.
    static History reversed(History history) {
        for (std::size_t c = 0; c < vectors_count; ++c) history[c] = -history[c];
        return history;
    }

    /// Gap up to which a pair of effective radius R* [m] may act on each other [m].
    Real reach(const Real& effective_radius) const {
        using std::max;
        return max(elasticity.reach(effective_radius), surface_force.reach());
    }
};

}  // namespace talus::dem
