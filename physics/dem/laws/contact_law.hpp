#pragma once
#include <array>
#include <cstddef>

#include "physics/dem/laws/attraction.hpp"
#include "physics/dem/laws/elasticity.hpp"
#include "physics/dem/laws/friction.hpp"
#include "physics/dem/laws/rolling.hpp"
#include "physics/dem/laws/twisting.hpp"

namespace talus::dem {

/// A contact law: its parts with the coefficients of one pair of materials. All members of all parts are of
/// the type Real, so that laws of doubles can be gathered to a law of lanes (pair_table.hpp).
///
/// History: `history_count` values a contact, zero when a contact begins and set to zero when it has ended;
/// the displacements of friction, rolling and twisting, in this order, as the first side sees them.
template <class Real_, class Elasticity, class Friction, class Rolling, class Twisting, class Attraction>
struct ContactLaw {
    using Real = Real_;
    Elasticity elasticity;
    [[no_unique_address]] Friction friction;
    [[no_unique_address]] Rolling rolling;
    [[no_unique_address]] Twisting twisting;
    [[no_unique_address]] Attraction attraction;

    static constexpr std::size_t history_count =
        Friction::history_count + Rolling::history_count + Twisting::history_count;
    using History = std::array<Real, history_count>;

    /// Force and couple on the first side; advances the history by the time step. Zero, with a history of
    /// zeros, if the pair does not touch and is out of the attraction's reach.
    ContactLoad<Real> operator()(const ContactKinematics<Real>& k, History& history) const {
        constexpr std::size_t rolls = Friction::history_count, twists = rolls + Rolling::history_count;
        const auto touching = k.overlap > 0;
        const ElasticResponse<Real> elastic = elasticity(k);
        const Real attracting = attraction(k);
        const Real normal_force = select(touching, elastic.normal_force, Real(0.0)) - attracting;
        // What presses the surfaces together, whether from outside or by their attraction.
        const Real load = select(touching, normal_force + attraction.adds_to_friction(attracting), Real(0.0));
        ContactLoad<Real> result;
        result.force = normal_force * k.normal + friction(k, elastic, load, history.data());
        result.couple = rolling(k, elastic, load, history.data() + rolls) +
                        twisting(k, elastic, load, history.data() + twists);
        for (Real& value : history) value = select(touching, value, Real(0.0));
        return result;
    }

    /// The history as the second side sees it.
    static History reversed(History history) {
        for (std::size_t c = 0; c < Friction::history_count + Rolling::history_count; ++c)
            history[c] = -history[c];
        return history;
    }

    /// Gap up to which a pair acts on each other [m].
    Real reach() const { return attraction.reach(); }
};

}  // namespace talus::dem
