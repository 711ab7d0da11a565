#pragma once
#include "comm/communicator.hpp"
#include "domain/box.hpp"
#include "domain/particles.hpp"

namespace talus {

/// What came of grains that overlapped.
struct Shrunk {
    std::uint64_t grains = 0;  ///< that are smaller now
    double least = 1;          ///< radius over that of before, of the one that shrank most [1]
    std::uint64_t id = 0;      ///< of that grain
};

/// Makes grains that overlap smaller until none does, and leaves the others alone: both grains of a pair by
/// the share d/(R_i + R_j) that just lets them touch, a grain by the least of its pairs. Masses, positions
/// and velocities stay, and spins grow as R^-2, so that mass, momentum and angular momentum do not change
/// while the energy of spin does. The grains may be on other ranks afterwards; the same bits on any number of
/// ranks. Collective.
Shrunk shrink_overlapping(const Communicator& comm, const Box& box, ParticleSet& grains);

}  // namespace talus
