#pragma once
#include <variant>

#include "physics/dem/laws/contact_law.hpp"
#include "physics/dem/laws/pair_table.hpp"

namespace talus::dem {

template <class Real>
using HertzLaw = ContactLaw<Real, HertzMindlin<Real>, CoulombFriction<Real>, RollsFreely<Real>,
                            TwistsFreely<Real>, NoSurfaceForce<Real>>;
template <class Real>
using RollingHertzLaw = ContactLaw<Real, HertzMindlin<Real>, CoulombFriction<Real>,
                                   ElasticPlasticRolling<Real>, TwistsFreely<Real>, NoSurfaceForce<Real>>;
template <class Real>
using LinearLaw = ContactLaw<Real, LinearSpring<Real>, CoulombFriction<Real>, RollsFreely<Real>,
                             TwistsFreely<Real>, NoSurfaceForce<Real>>;
template <class Real>
using RollingLinearLaw = ContactLaw<Real, LinearSpring<Real>, CoulombFriction<Real>,
                                    ElasticPlasticRolling<Real>, TwistsFreely<Real>, NoSurfaceForce<Real>>;

/// One law for all pairs of materials of a scene.
template <template <class> class Law_>
struct LawTable {
    using Law = Law_<double>;
    using LawOfLanes = Law_<Lanes>;
    PairTable<Law> pairs;
};

/// What a scene may choose from: the loops are compiled once for each.
using AnyLawTable = std::variant<LawTable<HertzLaw>, LawTable<RollingHertzLaw>, LawTable<LinearLaw>,
                                 LawTable<RollingLinearLaw>>;

}  // namespace talus::dem
