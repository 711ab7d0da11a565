#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "comm/communicator.hpp"
#include "domain/particles.hpp"
#include "io/agree.hpp"
#include "io/run_state.hpp"

namespace talus {

/// A field to be written to snapshots.
struct SnapshotField {
    const FieldInfo* field;
    bool single_precision = false;  ///< doubles become floats, at half the size
    std::string name = {};          ///< snapshot_name(field) if empty
    std::string description = {};   ///< the field's if empty
};

/// Snapshots of a set are numbered with six digits, from 0 on.
inline constexpr std::uint64_t most_snapshots = 1000000;

/// The name a field has in snapshots: that of GADGET's family where there is one (Velocities, Masses), the
/// field's words run together otherwise.
std::string snapshot_name(const FieldInfo& field);

/// Writes `directory`/<set>_<index>.hdf with positions, ids and `fields`, in order of id: plainly named
/// datasets in /PartType0 with units and descriptions, and a view of the same data that ParaView opens
/// (VTKHDF 1.0). Adds it with its time to `directory`/<set>.hdf.series. Vectors have three components and
/// tensors six (in VTK's order xx yy zz xy yz xz) or nine in any dimension; what a run in 1D or 2D lacks is
/// zero, but deviatoric stresses are completed to be traceless. Throws AgreedError (exit code 3) and leaves
/// no part of a file. Collective.
void write_snapshot(const Communicator& comm, const std::filesystem::path& directory, std::uint64_t index,
                    const RunState& state, const ParticleSet& set, const std::vector<SnapshotField>& fields);

}  // namespace talus
