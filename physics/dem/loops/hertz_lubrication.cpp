#include "physics/dem/loops/pair_loop.hpp"

template talus::dem::Overload
talus::dem::evaluate_family<talus::dem::HertzMindlin<>, talus::dem::Lubrication<>>(
    const Evaluation& evaluation, const AnyLawTable& laws, Pairs which, ContactList& list);
