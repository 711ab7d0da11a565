#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "domain/particles.hpp"

namespace talus::test {

/// A particle as analyses see it.
struct Grain {
    std::uint64_t id = 0;
    std::array<double, 3> position{}, velocity{};
    double mass = 1, damage = 0;
    std::uint8_t body = 0;
};

/// The share of a rank, in an order and at an owner that `salt` chooses.
ParticleSet share_of(const std::vector<Grain>& grains, int dimension, int rank, int ranks, unsigned salt);

}  // namespace talus::test
