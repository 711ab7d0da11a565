#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "comm/communicator.hpp"
#include "domain/particles.hpp"
#include "physics/dem/clumps/clump_motion.hpp"
#include "physics/dem/contact_loads.hpp"

namespace talus {

/// When grains have come to rest before time 0.
struct GrainSettling {
    double imbalance = 0.01;       ///< rms force on a grain over rms force of a contact, at most
    int lasting = 10;              ///< looks in a row that must find it so
    std::uint64_t interval = 100;  ///< steps between looks
    double longest = 0;            ///< the run begins at minus this time [s]
    double damping = 0;            ///< velocities fall as exp(-t/damping) [s]; 0: they do not
};

/// Root of the mean square of the net forces, weight included, on the grains that are not held (a clump is
/// one), over that of the forces of the contacts; infinite if nothing touches. Exact sums. Collective.
double force_imbalance(const Communicator& comm, const ParticleSet& grains,
                       std::span<const std::uint8_t> held, const dem::ClumpMotion& clumps,
                       std::span<const dem::LoadedContact> contacts);

}  // namespace talus
