#pragma once
#include <filesystem>
#include <string>

/// Looking into files, on one rank and without a scene. All throw AgreedError (exit code 3) if the file
/// cannot be understood.
namespace talus {

/// What is in a checkpoint or snapshot.
struct FileDescription {
    /// Several lines: format, step, time, sets, fields with units, counts and ranges, whether checksums hold.
    std::string text;
    bool intact;  ///< all checksums hold
};
/// A folder means its newest checkpoint.
FileDescription describe_file(const std::filesystem::path& file_or_folder);

/// state_hash() of the state in a checkpoint; a folder means its newest one. Checksums are verified.
std::string hash_file(const std::filesystem::path& file_or_folder);

/// Whether this rank could not close a file, on a full disk for example. HDF5 would try again when MPI ends,
/// and crash.
bool files_are_stuck();

}  // namespace talus
