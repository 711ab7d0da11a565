#pragma once
#include <cstddef>

#include "physics/dem/laws/elasticity.hpp"

namespace talus::dem {

/// Stands for a part that a law does without; `part` tells a law's absent parts apart, so that none takes
/// room.
template <class Real, int part>
struct NoResistance {
    static constexpr std::size_t history_count = 0;
    Vector3<Real> operator()(const ContactKinematics<Real>&, const ElasticResponse<Real>&, const Real&,
                             Real*) const {
        return {};
    }
};

template <class Real = double>
using Frictionless = NoResistance<Real, 0>;
template <class Real = double>
using RollsFreely = NoResistance<Real, 1>;
template <class Real = double>
using TwistsFreely = NoResistance<Real, 2>;

}  // namespace talus::dem
