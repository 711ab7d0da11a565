#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "io/hdf5_file.hpp"
#include "io/run_state.hpp"

/// What a checkpoint file holds behind the index of file_guard.hpp: /state (attributes), /scene and
/// /resolved_scene (texts), and a dataset /sets/<set>/<field> for every field, rows in order of id. Inside of
/// io/.
namespace talus {

inline constexpr const char* checkpoint_format = "talus-checkpoint";
inline constexpr std::uint64_t checkpoint_format_version = 1;

struct StoredField {
    std::string name;
    hdf5::Extent extent;
    std::uint64_t checksum = 0;
    std::string unit;
};

struct StoredSet {
    std::string name;
    int dimension = 3;
    std::uint64_t count = 0;
    std::vector<StoredField> fields;  ///< sorted by name
};

struct CheckpointLayout {
    RunState state;
    std::vector<StoredSet> sets;  ///< sorted by name
};

/// Adds /state and the scenes.
void write_run_state(hid_t file, const RunState& state);

/// Reads all but the particle data, on one rank. Throws std::runtime_error "file: section: what is wrong".
CheckpointLayout read_layout(const std::filesystem::path& file);

/// For broadcasting.
std::string serialized(const CheckpointLayout& layout);
CheckpointLayout deserialized(const std::string& bytes);

}  // namespace talus
