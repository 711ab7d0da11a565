#pragma once
#include <filesystem>
#include <optional>
#include <vector>

#include "comm/communicator.hpp"
#include "domain/particles.hpp"
#include "io/agree.hpp"
#include "io/run_state.hpp"

namespace talus {

/// Writes `directory`/checkpoint_<step>.h5, complete and durable, or throws AgreedError on every rank and
/// leaves what was there untouched. The particle data are written in order of id, so that their bytes depend
/// neither on the number of ranks nor on the decomposition. Once the new file has been read back and synced,
/// it and the newest before it are kept, older ones are removed, and those of later steps (of a run that was
/// given up for this one) get the suffix .superseded. Collective.
void write_checkpoint(const Communicator& comm, const std::filesystem::path& directory, const RunState& state,
                      const std::vector<const ParticleSet*>& sets);

/// Writes the same as one file, and leaves all others alone. Collective.
void write_particle_sets(const Communicator& comm, const std::filesystem::path& file, const RunState& state,
                         const std::vector<const ParticleSet*>& sets);

/// Reads a checkpoint written by any number of ranks into `sets`, whose fields (ParticleSet::add) must be
/// those of the file. Every rank receives an equal share of the particles in order of id; they must then be
/// migrated to where they belong. Throws AgreedError (exit code 3) naming the file and its damaged section,
/// and an older checkpoint if there is one. Collective.
RunState read_checkpoint(const Communicator& comm, const std::filesystem::path& file,
                         const std::vector<ParticleSet*>& sets);

/// Reads one set of a file like the above, which may hold other sets, and of it only the fields that `set`
/// has. Collective.
RunState read_particle_set(const Communicator& comm, const std::filesystem::path& file, ParticleSet& set);

/// The run state alone, to build a simulation from its scene before its particles are read. Collective.
RunState read_checkpoint_state(const Communicator& comm, const std::filesystem::path& file);

/// The checkpoint that `what` means: a file, a folder (the newest in it), or "latest" (the newest in
/// `output_directory`). Throws AgreedError if there is none. Collective.
std::filesystem::path find_checkpoint(const Communicator& comm, const std::filesystem::path& what,
                                      const std::filesystem::path& output_directory);

/// Checkpoints of a folder, newest step first. For one rank.
std::vector<std::filesystem::path> list_checkpoints(const std::filesystem::path& directory);

}  // namespace talus
