#pragma once
#include <functional>
#include <string>
#include <vector>

#include "io/hdf5_file.hpp"
#include "io/id_order.hpp"

/// Writing and checking of HDF5 files with particle data, shared by checkpoints and snapshots. Inside of io/.
namespace talus {

/// One dataset to be written by all ranks together.
struct DatasetPlan {
    std::string path;  ///< with its groups, such as /sets/rock/density
    ValueType type = ValueType::f64;
    std::uint64_t total = 0;  ///< rows on all ranks
    std::size_t components = 1;
    std::string unit;  ///< UDUNITS string
    std::string description;
    RowRange rows;  ///< this rank's, whole blocks
    /// This rank's rows of a slab (slab_of). Collective.
    std::function<std::vector<std::byte>(std::uint64_t slab)> data;

    std::size_t row_bytes() const { return components * size_of(type); }
};

/// A file to be written.
struct ParticleFilePlan {
    std::filesystem::path file;
    bool guarded = false;  ///< with the index of file_guard.hpp
    std::vector<DatasetPlan> datasets;
    /// Adds everything else to the file once the (still empty) datasets are there. Called on the root only.
    std::function<void(hid_t file)> describe;
};

/// Writes the file under a temporary name, reads it back, syncs and renames it. Throws AgreedError on every
/// rank if anything fails; then neither the file nor the temporary one is left. Collective.
void write_particle_file(const Communicator& comm, const ParticleFilePlan& plan);

/// XXH64 of every block of whole rows.
std::vector<std::uint64_t> block_hashes(std::span<const std::byte> rows, std::size_t row_bytes);
/// The checksum of a dataset: XXH64 of the hashes of all its blocks in order.
std::uint64_t combined_hash(std::span<const std::uint64_t> hashes);

/// Name of the attribute with the checksum.
inline const std::string checksum_attribute = "xxh64_of_blocks";

/// Reads a dataset serially, block by block, calls `visit(rows, first_row)` for each and returns the
/// checksum.
std::uint64_t visit_blocks(const std::filesystem::path& file, const hdf5::Extent& extent,
                           const std::function<void(std::span<const std::byte>, std::uint64_t)>& visit);

}  // namespace talus
