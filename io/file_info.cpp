#include "io/file_info.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "io/agree.hpp"
#include "io/checkpoint.hpp"
#include "io/checkpoint_layout.hpp"
#include "io/durable.hpp"
#include "io/file_guard.hpp"
#include "io/hashing.hpp"
#include "io/particle_file.hpp"

namespace talus {
namespace {

/// Least and greatest of a field: of its value, or of its length if it has several components.
struct Extremes {
    double least = std::numeric_limits<double>::infinity();
    double greatest = -std::numeric_limits<double>::infinity();
    std::uint64_t not_finite = 0;
};

template <class T>
double value_as(const std::byte* from) {
    T value;
    std::memcpy(&value, from, sizeof value);
    return static_cast<double>(value);
}

double value_at(ValueType type, const std::byte* from) {
    switch (type) {
        case ValueType::f64:
            return value_as<double>(from);
        case ValueType::f32:
            return value_as<float>(from);
        case ValueType::u64:
            return value_as<std::uint64_t>(from);
        case ValueType::u32:
            return value_as<std::uint32_t>(from);
        case ValueType::u8:
            return value_as<std::uint8_t>(from);
    }
    return 0;
}

void add_rows(std::span<const std::byte> rows, const hdf5::Extent& extent, Extremes& extremes) {
    const std::size_t size = size_of(extent.type);
    for (std::size_t at = 0; at < rows.size(); at += extent.row_bytes()) {
        double value = value_at(extent.type, rows.data() + at);
        for (std::size_t c = 1; c < extent.components; ++c)
            value = std::hypot(value, value_at(extent.type, rows.data() + at + c * size));
        if (extent.components > 1) value = std::abs(value);
        if (!std::isfinite(value)) {
            ++extremes.not_finite;
            continue;
        }
        extremes.least = std::min(extremes.least, value);
        extremes.greatest = std::max(extremes.greatest, value);
    }
}

/// One line on a dataset, whose data it reads; `intact` becomes false if the checksum does not hold.
std::string describe_field(const std::filesystem::path& file, const StoredField& field, bool& intact) {
    Extremes extremes;
    const std::uint64_t checksum = visit_blocks(
        file, field.extent,
        [&](std::span<const std::byte> rows, std::uint64_t) { add_rows(rows, field.extent, extremes); });
    constexpr const char* types[] = {"f64", "f32", "u64", "u32", "u8"};
    const std::string shape =
        field.extent.components > 1 ? fmt::format(" x {}", field.extent.components) : "";
    std::string line =
        fmt::format("    {:<22} {:<8} {:<8}", field.name,
                    fmt::format("{}{}", types[static_cast<int>(field.extent.type)], shape), field.unit);
    const char* what = field.extent.components > 1 ? "length " : "";
    if (extremes.least <= extremes.greatest)
        line += fmt::format("  {}{:.6g} to {:.6g}", what, extremes.least, extremes.greatest);
    if (extremes.not_finite > 0) line += fmt::format("  {} NOT FINITE", extremes.not_finite);
    if (checksum != field.checksum) {
        line += "  DAMAGED: checksum does not match";
        intact = false;
    }
    return line + "\n";
}

std::string describe_set(const std::filesystem::path& file, const StoredSet& set, bool& intact) {
    std::string text =
        fmt::format("  set {}: {} particles in {} dimensions\n", set.name, set.count, set.dimension);
    for (const StoredField& field : set.fields) text += describe_field(file, field, intact);
    return text;
}

FileDescription with_verdict(const std::string& text, bool intact) {
    return {text + (intact ? "  checksums: all match\n" : "  checksums: DAMAGED, see above\n"), intact};
}

FileDescription describe_checkpoint(const std::filesystem::path& file) {
    const CheckpointLayout layout = read_layout(file);
    const RunState& state = layout.state;
    std::string text = fmt::format("{}: checkpoint (format {}) of talus {}\n", file.string(),
                                   checkpoint_format_version, state.version);
    text += fmt::format("  step {}, time {} s, time step {} s\n", state.step, state.time, state.time_step);
    for (const auto& [name, value] : state.numbers) text += fmt::format("  {} = {}\n", name, value);
    bool intact = true;
    for (const StoredSet& set : layout.sets) text += describe_set(file, set, intact);
    return with_verdict(text, intact);
}

FileDescription describe_snapshot(const std::filesystem::path& path) {
    const hdf5::Handle file = hdf5::open_file(path, false);
    if (!hdf5::has_attribute(file, "format") || hdf5::text_attribute(file, "format") != "talus-snapshot")
        throw std::runtime_error(
            fmt::format("{}: neither a checkpoint nor a snapshot of Talus", path.string()));
    const hdf5::Handle header = hdf5::open_group(file, "/Header");
    std::string text = fmt::format("{}: snapshot (format {}) of talus {}\n", path.string(),
                                   hdf5::integer_attribute(file, "format_version"),
                                   hdf5::text_attribute(file, "code_version"));
    text += fmt::format("  step {}, time {} s, time step {} s\n", hdf5::integer_attribute(header, "Step"),
                        hdf5::double_attribute(header, "Time"), hdf5::double_attribute(header, "TimeStep"));
    StoredSet set;
    set.name = hdf5::text_attribute(header, "ParticleSet");
    set.dimension = static_cast<int>(hdf5::integer_attribute(header, "Dimension"));
    const hdf5::Handle group = hdf5::open_group(file, "/PartType0");
    for (const std::string& name : hdf5::children(group)) {
        const hdf5::Handle dataset = hdf5::open_dataset(group, name);
        set.fields.push_back({name, hdf5::extent_of(dataset),
                              hdf5::integer_attribute(dataset, checksum_attribute),
                              hdf5::text_attribute(dataset, "units")});
        set.count = set.fields.back().extent.rows;
    }
    bool intact = true;
    text += describe_set(path, set, intact);
    return with_verdict(text, intact);
}

/// Adds all particles of a set to the hash, reading all its fields side by side.
void hash_set(const std::filesystem::path& file, const StoredSet& set, StateHash& hash) {
    std::vector<StateColumn> columns;
    std::size_t row_bytes = 0;
    for (const StoredField& field : set.fields) {  // sorted by name
        columns.push_back({field.name, size_of(field.extent.type), field.extent.components});
        row_bytes += field.extent.row_bytes();
    }
    hash.begin_set(set.name, set.dimension, columns);
    const FileReader reader(file);
    std::vector<std::vector<std::uint64_t>> hashes(set.fields.size());
    std::vector<std::byte> block, rows;
    for (std::uint64_t first = 0; first < set.count; first += rows_per_block) {
        const std::uint64_t count = std::min(rows_per_block, set.count - first);
        rows.resize(count * row_bytes);
        std::size_t column_start = 0;
        for (std::size_t k = 0; k < set.fields.size(); ++k) {
            const hdf5::Extent& extent = set.fields[k].extent;
            block.resize(count * extent.row_bytes());
            reader.read(extent.offset + first * extent.row_bytes(), block);
            hashes[k].push_back(hash64(block));
            for (std::uint64_t row = 0; row < count; ++row)
                std::memcpy(rows.data() + row * row_bytes + column_start,
                            block.data() + row * extent.row_bytes(), extent.row_bytes());
            column_start += extent.row_bytes();
        }
        for (std::uint64_t row = 0; row < count; ++row)
            hash.add_particle(std::span(rows).subspan(row * row_bytes, row_bytes));
    }
    for (std::size_t k = 0; k < set.fields.size(); ++k)
        if (combined_hash(hashes[k]) != set.fields[k].checksum)
            throw std::runtime_error(fmt::format("{}: /sets/{}/{}: damaged, checksum does not match",
                                                 file.string(), set.name, set.fields[k].name));
}

/// Runs an action of this one rank, its failures as those of input and output.
template <class Action>
auto or_input_output_failure(const Action& action) {
    try {
        return action();
    } catch (const std::exception& failure) {
        throw AgreedError(exit_input_output, failure.what());
    }
}

/// The file itself, or the newest checkpoint of a folder.
std::filesystem::path file_of(const std::filesystem::path& file_or_folder) {
    if (std::filesystem::is_regular_file(file_or_folder)) return file_or_folder;
    if (!std::filesystem::is_directory(file_or_folder))
        throw std::runtime_error(fmt::format("{}: no such file", file_or_folder.string()));
    const auto files = list_checkpoints(file_or_folder);
    if (files.empty())
        throw std::runtime_error(fmt::format("{}: no checkpoint in this folder", file_or_folder.string()));
    return files.front();
}

}  // namespace

FileDescription describe_file(const std::filesystem::path& file_or_folder) {
    return or_input_output_failure([&] {
        const std::filesystem::path file = file_of(file_or_folder);
        return is_guarded(file) ? describe_checkpoint(file) : describe_snapshot(file);
    });
}

std::string hash_file(const std::filesystem::path& file_or_folder) {
    return or_input_output_failure([&] {
        const std::filesystem::path file = file_of(file_or_folder);
        const CheckpointLayout layout = read_layout(file);
        StateHash hash;
        for (const StoredSet& set : layout.sets) hash_set(file, set, hash);
        return hash.finish(layout.state);
    });
}

}  // namespace talus
