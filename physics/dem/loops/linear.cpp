#include "physics/dem/loops/pair_loop.hpp"

template talus::dem::Overload
talus::dem::evaluate_family<talus::dem::LinearSpring<>, talus::dem::NoSurfaceForce<>>(
    const Evaluation& evaluation, const AnyLawTable& laws, Pairs which, ContactList& list);
