#pragma once
#include <vector>

#include "domain/particles.hpp"
#include "io/snapshot.hpp"
#include "physics/dem/contact_loads.hpp"

namespace talus {

/// The contacts whose first grain is this rank's own as a set to be written: the place where they touch as
/// position, ids of the two (of a wall as in checkpoints), normal, overlap and force. Row ids order them by
/// the ids of the two, as in checkpoints. `grains` with copied ids.
ParticleSet contact_set(std::vector<dem::LoadedContact> contacts, const ParticleSet& grains);

/// What of it is written besides place and row id.
std::vector<SnapshotField> contact_fields();

}  // namespace talus
