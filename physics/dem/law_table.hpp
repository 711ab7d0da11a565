#pragma once
#include <tuple>
#include <type_traits>
#include <variant>

#include "physics/dem/laws/contact_law.hpp"
#include "physics/dem/laws/pair_table.hpp"

namespace talus::dem {

/// One law for all pairs of materials of a scene, named by its parts; all have Coulomb's friction.
template <template <class> class Elasticity, template <class> class Rolling = RollsFreely,
          template <class> class Twisting = TwistsFreely,
          template <class> class SurfaceForce = NoSurfaceForce>
struct LawTable {
    template <class Real>
    using LawOf = ContactLaw<Real, Elasticity<Real>, CoulombFriction<Real>, Rolling<Real>, Twisting<Real>,
                             SurfaceForce<Real>>;
    using Law = LawOf<double>;
    using LawOfLanes = LawOf<Lanes>;
    PairTable<Law> pairs;
};

/// What acts along the normal: the loops over contacts are compiled in one file for each (loops/).
template <class Elasticity, class SurfaceForce, class Table>
inline constexpr bool is_of_family = std::is_same_v<decltype(Table::Law::elasticity), Elasticity>&&
    std::is_same_v<decltype(Table::Law::surface_force), SurfaceForce>;

/// The laws with every resistance to rolling and twisting.
template <template <class> class Elasticity, template <class> class SurfaceForce = NoSurfaceForce>
using LawFamily = std::tuple<LawTable<Elasticity, RollsFreely, TwistsFreely, SurfaceForce>,
                             LawTable<Elasticity, ConstantRollingTorque, TwistsFreely, SurfaceForce>,
                             LawTable<Elasticity, ElasticPlasticRolling, TwistsFreely, SurfaceForce>,
                             LawTable<Elasticity, RollsFreely, ContactAreaTwisting, SurfaceForce>,
                             LawTable<Elasticity, ConstantRollingTorque, ContactAreaTwisting, SurfaceForce>,
                             LawTable<Elasticity, ElasticPlasticRolling, ContactAreaTwisting, SurfaceForce>>;

template <class Tuple>
struct VariantOf;
template <class... Tables>
struct VariantOf<std::tuple<Tables...>> {
    using type = std::variant<Tables...>;
};

/// What a scene may choose from. Johnson's, Kendall's and Roberts's contacts pull by themselves.
using AnyLawTable = VariantOf<decltype(std::tuple_cat(
    std::declval<LawFamily<HertzMindlin>>(), std::declval<LawFamily<LinearSpring>>(),
    std::declval<LawFamily<JohnsonKendallRoberts>>(), std::declval<LawFamily<HertzMindlin, PullOff>>(),
    std::declval<LawFamily<LinearSpring, PullOff>>(), std::declval<LawFamily<HertzMindlin, Lubrication>>(),
    std::declval<LawFamily<LinearSpring, Lubrication>>()))>::type;

}  // namespace talus::dem
