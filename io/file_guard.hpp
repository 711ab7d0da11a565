#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

/// A text index in the user block in front of an HDF5 file. HDF5 (1.10) may crash or loop on damaged
/// metadata, so these are checked before HDF5 sees the file; and a file that is cut short can be named by
/// what it lacks. All functions are for one rank and throw std::runtime_error.
namespace talus {

/// Bytes of a file that have a checksum of their own.
struct DataRegion {
    std::string name;
    std::uint64_t offset = 0, bytes = 0;
};

/// Size of the user block for that many regions: a power of two, as HDF5 wants it.
std::uint64_t guard_size(std::size_t regions);

/// Writes the index: size of the file, places of the data, checksum of everything else. The last change to a
/// file.
void write_guard(const std::filesystem::path& file, const std::vector<DataRegion>& regions);

/// Whether the file begins like one with such an index.
bool is_guarded(const std::filesystem::path& file);

/// Checks the file's size and everything but the data. Messages begin with the damaged section.
void check_guard(const std::filesystem::path& file);

}  // namespace talus
