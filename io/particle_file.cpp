#include "io/particle_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "io/agree.hpp"
#include "io/durable.hpp"
#include "io/file_guard.hpp"
#include "io/hashing.hpp"

namespace talus {
namespace {

using hdf5::Handle;

struct Written {
    std::vector<std::uint64_t> hashes;  ///< of this rank's blocks
    std::uint64_t checksum = 0;         ///< of the dataset, on the root
    std::uint64_t offset = 0;           ///< of the dataset in the file
};

/// Lays out the file on one rank: all metadata, and room on disk for the data.
void create_layout(const ParticleFilePlan& plan, const std::filesystem::path& temporary,
                   std::vector<Written>& written) {
    std::uint64_t bytes = std::uint64_t{1} << 20;
    for (const DatasetPlan& dataset : plan.datasets) bytes += dataset.total * dataset.row_bytes();
    check_space(temporary.has_parent_path() ? temporary.parent_path() : ".", bytes);
    Handle file = hdf5::create_file(temporary, plan.guarded ? guard_size(plan.datasets.size()) : 0);
    for (std::size_t k = 0; k < plan.datasets.size(); ++k) {
        const DatasetPlan& dataset = plan.datasets[k];
        const auto slash = dataset.path.rfind('/');
        if (slash != 0 && H5Lexists(file, dataset.path.substr(0, slash).c_str(), H5P_DEFAULT) <= 0)
            hdf5::create_group(file, dataset.path.substr(0, slash));
        const Handle made =
            hdf5::create_dataset(file, dataset.path, dataset.type, dataset.total, dataset.components);
        hdf5::set_attribute(made, "units", dataset.unit);
        hdf5::set_attribute(made, "unitSI", 1.0);
        hdf5::set_attribute(made, "description", dataset.description);
        hdf5::set_attribute(made, "rows_per_block", rows_per_block);
        hdf5::set_attribute(made, checksum_attribute, std::uint64_t{0});
        written[k].offset = hdf5::extent_of(made).offset;
    }
    plan.describe(file);
    file.close("write the layout");
    reserve_space(temporary);
}

/// Every rank writes its rows where HDF5 has laid out the dataset, by the system's own calls: MPI-IO can
/// report success on a full disk, and leaves a locked semaphore behind where a rank dies
/// (docs/decisions/026-writing-files.md).
void write_dataset(const Communicator& comm, const FileWriter& file, const DatasetPlan& plan,
                   Written& written) {
    if (plan.total == 0) {
        written.checksum = combined_hash({});
        return;
    }
    const std::uint64_t slabs = comm.all_max(slabs_in(plan.rows));
    for (std::uint64_t k = 0; k < slabs; ++k) {
        const RowRange range = slab_of(plan.rows, k);
        const std::vector<std::byte> bytes = plan.data(k);
        agree_on(comm, [&] {
            if (bytes.size() != range.count() * plan.row_bytes())
                throw std::logic_error("wrong number of rows");
            file.write(written.offset + range.begin * plan.row_bytes(), bytes);
        });
        const std::vector<std::uint64_t> hashes = block_hashes(bytes, plan.row_bytes());
        written.hashes.insert(written.hashes.end(), hashes.begin(), hashes.end());
    }
    written.checksum = combined_hash(comm.all_gather(std::span<const std::uint64_t>(written.hashes)));
}

/// Reads back what this rank wrote: what a disk says of a write is not enough.
void verify(const std::filesystem::path& temporary, const ParticleFilePlan& plan,
            const std::vector<Written>& written) {
    const FileReader reader(temporary);
    std::vector<std::byte> block;
    for (std::size_t k = 0; k < plan.datasets.size(); ++k) {
        const DatasetPlan& dataset = plan.datasets[k];
        std::uint64_t row = dataset.rows.begin;
        for (const std::uint64_t hash : written[k].hashes) {
            const std::uint64_t end = std::min(row + rows_per_block, dataset.rows.end);
            block.resize((end - row) * dataset.row_bytes());
            reader.read(written[k].offset + row * dataset.row_bytes(), block);
            if (hash64(block) != hash)
                throw std::runtime_error(fmt::format("{} does not read back as written", dataset.path));
            row = end;
        }
    }
}

void write_temporary(const Communicator& comm, const ParticleFilePlan& plan,
                     const std::filesystem::path& temporary) {
    std::vector<Written> written(plan.datasets.size());
    agree_on_root(comm, [&] { create_layout(plan, temporary, written); });
    for (Written& one : written) one.offset = comm.all_max(one.offset);

    std::optional<FileWriter> file;
    agree_on(comm, [&] { file.emplace(temporary); });
    for (std::size_t k = 0; k < plan.datasets.size(); ++k)
        write_dataset(comm, *file, plan.datasets[k], written[k]);
    agree_on(comm, [&] {
        file.reset();
        sync_file(temporary);
    });

    agree_on_root(comm, [&] {
        Handle serial = hdf5::open_file(temporary, true);
        for (std::size_t k = 0; k < plan.datasets.size(); ++k)
            hdf5::change_attribute(hdf5::open_dataset(serial, plan.datasets[k].path), checksum_attribute,
                                   written[k].checksum);
        serial.close("write the checksums");
        if (!plan.guarded) return;
        std::vector<DataRegion> regions;
        for (std::size_t k = 0; k < plan.datasets.size(); ++k)
            if (const DatasetPlan& dataset = plan.datasets[k]; dataset.total > 0)
                regions.push_back({dataset.path, written[k].offset, dataset.total * dataset.row_bytes()});
        write_guard(temporary, regions);
    });
    agree_on(comm, [&] {
        sync_file(temporary);
        verify(temporary, plan, written);
    });
}

}  // namespace

void write_particle_file(const Communicator& comm, const ParticleFilePlan& plan) {
    const std::filesystem::path temporary = temporary_name(plan.file);
    try {
        agree_on_root(comm, [&] {
            if (plan.file.has_parent_path()) std::filesystem::create_directories(plan.file.parent_path());
        });
        write_temporary(comm, plan, temporary);
        agree_on_root(comm, [&] { publish(temporary, plan.file); });
    } catch (const AgreedError& failure) {
        std::error_code ignored;
        if (comm.is_root()) std::filesystem::remove(temporary, ignored);
        throw AgreedError(failure.exit_code,
                          fmt::format("{}: not written: {}", plan.file.string(), failure.what()));
    }
}

std::vector<std::uint64_t> block_hashes(std::span<const std::byte> rows, std::size_t row_bytes) {
    std::vector<std::uint64_t> hashes;
    const std::size_t block = rows_per_block * row_bytes;
    for (std::size_t at = 0; at < rows.size(); at += block)
        hashes.push_back(hash64(rows.subspan(at, std::min(block, rows.size() - at))));
    return hashes;
}

std::uint64_t combined_hash(std::span<const std::uint64_t> hashes) { return hash64(std::as_bytes(hashes)); }

std::uint64_t visit_blocks(const std::filesystem::path& file, const hdf5::Extent& extent,
                           const std::function<void(std::span<const std::byte>, std::uint64_t)>& visit) {
    const FileReader reader(file);
    std::vector<std::uint64_t> hashes;
    std::vector<std::byte> block;
    for (std::uint64_t row = 0; row < extent.rows; row += rows_per_block) {
        block.resize(std::min(rows_per_block, extent.rows - row) * extent.row_bytes());
        reader.read(extent.offset + row * extent.row_bytes(), block);
        hashes.push_back(hash64(block));
        visit(block, row);
    }
    return combined_hash(hashes);
}

}  // namespace talus
