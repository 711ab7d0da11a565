#include "io/checkpoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>

#include "io/checkpoint_layout.hpp"
#include "io/durable.hpp"
#include "io/hashing.hpp"
#include "io/id_order.hpp"
#include "io/particle_file.hpp"
#include "io/row_packing.hpp"

namespace talus {
namespace {

constexpr std::string_view prefix = "checkpoint_", suffix = ".h5";
constexpr std::size_t kept = 2;

/// The step in a checkpoint's file name, -1 if it is not one.
std::int64_t step_of(const std::filesystem::path& file) {
    const std::string name = file.filename().string();
    if (name.size() <= prefix.size() + suffix.size() || !name.starts_with(prefix) || !name.ends_with(suffix))
        return -1;
    std::int64_t step = -1;
    const char* const last = name.data() + name.size() - suffix.size();
    const auto [end, failure] = std::from_chars(name.data() + prefix.size(), last, step);
    return failure == std::errc() && end == last ? step : -1;
}

constexpr std::string_view put_aside = ".superseded";

/// Removes the files of the folder that are named as a checkpoint with `ending`.
void remove_ending(const std::filesystem::path& directory, std::string_view ending) {
    std::vector<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::directory_iterator(directory))
        if (entry.path().extension() == ending && step_of(entry.path().stem()) >= 0)
            found.push_back(entry.path());
    for (const std::filesystem::path& file : found) std::filesystem::remove(file);
}

/// Removes all but the newest checkpoints up to `step`, and what interrupted writers left. Later steps belong
/// to a run that was given up for this one: those are put aside, and what was put aside before goes.
void remove_old(const std::filesystem::path& directory, std::uint64_t step) {
    remove_ending(directory, ".tmp");
    const std::vector<std::filesystem::path> files = list_checkpoints(directory);
    const auto is_later = [&](const auto& file) { return step_of(file) > static_cast<std::int64_t>(step); };
    if (std::any_of(files.begin(), files.end(), is_later)) remove_ending(directory, put_aside);
    std::size_t seen = 0;
    for (const std::filesystem::path& file : files) {
        if (is_later(file))
            std::filesystem::rename(file, fmt::format("{}{}", file.string(), put_aside));
        else if (++seen > kept)
            std::filesystem::remove(file);
    }
}

void describe(hid_t file, const RunState& state, const std::vector<const ParticleSet*>& sets,
              const std::vector<IdOrder>& orders) {
    write_run_state(file, state);
    for (std::size_t k = 0; k < sets.size(); ++k) {
        const hdf5::Handle group = hdf5::open_group(file, "/sets/" + sets[k]->name());
        hdf5::set_attribute(group, "dimension", static_cast<std::uint64_t>(sets[k]->dimension()));
        hdf5::set_attribute(group, "count", orders[k].total());
        hdf5::set_attribute(group, "fields", static_cast<std::uint64_t>(state_columns(*sets[k]).size()));
    }
    const hdf5::Handle group = hdf5::open_group(file, "/sets");
    hdf5::set_attribute(group, "count", static_cast<std::uint64_t>(sets.size()));
}

/// " An older checkpoint is there: ..." or nothing.
std::string offer_older(const std::filesystem::path& file) {
    const std::filesystem::path directory = file.has_parent_path() ? file.parent_path() : ".";
    try {
        for (const std::filesystem::path& other : list_checkpoints(directory))
            if (step_of(other) < step_of(file))
                return fmt::format("; the checkpoint before it is there: --restart {}", other.string());
    } catch (const std::exception&) {  // an offer is not worth a second failure
    }
    return "";
}

AgreedError with_offer(const Communicator& comm, const std::filesystem::path& file,
                       const AgreedError& failure) {
    const std::string offer = comm.all_broadcast(comm.is_root() ? offer_older(file) : "");
    return AgreedError(failure.exit_code, failure.what() + offer);
}

CheckpointLayout read_layout_together(const Communicator& comm, const std::filesystem::path& file) {
    std::string bytes;
    agree_on_root(comm, [&] { bytes = serialized(read_layout(file)); });
    return deserialized(comm.all_broadcast(std::move(bytes)));
}

/// Whether a set must have all fields of a file.
enum class Fields : std::uint8_t { all, those_asked_for };

/// Says what differs between the fields of the file and those that the run needs.
void check_fields(const std::filesystem::path& file, const StoredSet& stored, const ParticleSet& set,
                  Fields which) {
    const auto fail = [&](const std::string& what) {
        throw std::runtime_error(fmt::format("{}: particle set {}: {}", file.string(), set.name(), what));
    };
    if (stored.dimension != set.dimension())
        fail(fmt::format("has {} dimensions, the scene {}", stored.dimension, set.dimension()));
    std::set<std::string> unused;
    for (const StoredField& field : stored.fields) unused.insert(field.name);
    for (const Column* column : state_columns(set)) {
        const std::string name(column->info->name);
        const auto found = std::find_if(stored.fields.begin(), stored.fields.end(),
                                        [&](const StoredField& field) { return field.name == name; });
        if (found == stored.fields.end())
            fail(fmt::format("field {} is not in the file, but the scene needs it", name));
        if (found->extent.type != column->info->type ||
            found->extent.components != column->components.size() || found->unit != column->info->unit)
            fail(fmt::format("field {} has another type, shape or unit than this program's", name));
        unused.erase(name);
    }
    if (which == Fields::all && !unused.empty())
        fail(fmt::format("field {} is in the file, but the scene does not have it", *unused.begin()));
}

void read_set(const Communicator& comm, const std::filesystem::path& file, const StoredSet& stored,
              ParticleSet& set) {
    const RowRange rows = rows_of_rank(stored.count, comm.rank(), comm.size());
    set.resize(rows.count());
    std::vector<std::byte> bytes;
    for (const StoredField& field : stored.fields) {
        const auto column = std::find_if(set.columns().begin(), set.columns().end(), [&](const Column& one) {
            return one.info->role == Role::state && one.info->name == field.name;
        });
        if (column == set.columns().end()) continue;
        std::vector<std::uint64_t> hashes;
        agree_on(comm, [&] {
            const std::size_t row_bytes = field.extent.row_bytes();
            const FileReader reader(file);
            for (std::uint64_t slab = 0; slab < slabs_in(rows); ++slab) {
                const RowRange range = slab_of(rows, slab);
                bytes.resize(range.count() * row_bytes);
                reader.read(field.extent.offset + range.begin * row_bytes, bytes);
                for (const std::uint64_t hash : block_hashes(bytes, row_bytes)) hashes.push_back(hash);
                unpack_rows(bytes, *column, range.begin - rows.begin);
            }
        });
        const auto all_hashes = comm.all_gather(std::span<const std::uint64_t>(hashes));
        if (combined_hash(all_hashes) != field.checksum)
            throw AgreedError(exit_input_output,
                              fmt::format("{}: /sets/{}/{}: damaged, checksum does not match", file.string(),
                                          stored.name, field.name));
    }
}

/// Finds the set in the file, checks its fields and reads them.
void read_set(const Communicator& comm, const std::filesystem::path& file, const CheckpointLayout& layout,
              ParticleSet& set, Fields which) {
    const auto stored = std::find_if(layout.sets.begin(), layout.sets.end(),
                                     [&](const StoredSet& one) { return one.name == set.name(); });
    agree_on(comm, [&] {
        if (stored == layout.sets.end())
            throw std::runtime_error(
                fmt::format("{}: particle set {} is not in it", file.string(), set.name()));
        check_fields(file, *stored, set, which);
    });
    read_set(comm, file, *stored, set);
}

}  // namespace

void write_particle_sets(const Communicator& comm, const std::filesystem::path& file, const RunState& state,
                         const std::vector<const ParticleSet*>& sets) {
    ParticleFilePlan plan;
    plan.file = file;
    plan.guarded = true;
    std::vector<IdOrder> orders;
    orders.reserve(sets.size());
    for (const ParticleSet* set : sets) orders.emplace_back(comm, set->own(field::id), set->name());
    for (std::size_t k = 0; k < sets.size(); ++k) {
        for (const Column* column : state_columns(*sets[k])) {
            const IdOrder& order = orders[k];
            DatasetPlan dataset;
            dataset.path = fmt::format("/sets/{}/{}", sets[k]->name(), column->info->name);
            dataset.type = column->info->type;
            dataset.total = order.total();
            dataset.components = column->components.size();
            dataset.unit = column->info->unit;
            dataset.description = column->info->description;
            dataset.rows = order.rows();
            dataset.data = [&order, column, row_bytes = dataset.row_bytes()](std::uint64_t slab) {
                return order.exchange(slab, row_bytes, [column](std::span<const std::uint32_t> particles) {
                    return pack_rows(*column, particles);
                });
            };
            plan.datasets.push_back(std::move(dataset));
        }
    }
    plan.describe = [&](hid_t opened) { describe(opened, state, sets, orders); };
    write_particle_file(comm, plan);
}

void write_checkpoint(const Communicator& comm, const std::filesystem::path& directory, const RunState& state,
                      const std::vector<const ParticleSet*>& sets) {
    write_particle_sets(comm, directory / fmt::format("{}{:09}{}", prefix, state.step, suffix), state, sets);
    agree_on_root(comm, [&] { remove_old(directory, state.step); });
}

RunState read_checkpoint(const Communicator& comm, const std::filesystem::path& file,
                         const std::vector<ParticleSet*>& sets) {
    try {
        const CheckpointLayout layout = read_layout_together(comm, file);
        if (layout.sets.size() != sets.size())
            throw AgreedError(exit_input_output, fmt::format("{}: holds {} particle sets, the scene {}",
                                                             file.string(), layout.sets.size(), sets.size()));
        for (ParticleSet* set : sets) read_set(comm, file, layout, *set, Fields::all);
        return layout.state;
    } catch (const AgreedError& failure) {
        throw with_offer(comm, file, failure);
    }
}

RunState read_particle_set(const Communicator& comm, const std::filesystem::path& file, ParticleSet& set) {
    const CheckpointLayout layout = read_layout_together(comm, file);
    read_set(comm, file, layout, set, Fields::those_asked_for);
    return layout.state;
}

RunState read_checkpoint_state(const Communicator& comm, const std::filesystem::path& file) {
    try {
        return read_layout_together(comm, file).state;
    } catch (const AgreedError& failure) {
        throw with_offer(comm, file, failure);
    }
}

std::vector<std::filesystem::path> list_checkpoints(const std::filesystem::path& directory) {
    std::vector<std::filesystem::path> files;
    if (!std::filesystem::is_directory(directory)) return files;
    for (const auto& entry : std::filesystem::directory_iterator(directory))
        if (step_of(entry.path()) >= 0) files.push_back(entry.path());
    std::sort(files.begin(), files.end(),
              [](const auto& a, const auto& b) { return step_of(a) > step_of(b); });
    return files;
}

std::filesystem::path find_checkpoint(const Communicator& comm, const std::filesystem::path& what,
                                      const std::filesystem::path& output_directory) {
    std::string found;
    agree_on_root(comm, [&] {
        const std::filesystem::path place = what == "latest" ? output_directory : what;
        if (what != "latest" && !std::filesystem::exists(place))
            throw std::runtime_error(fmt::format("{}: no such checkpoint", place.string()));
        if (what != "latest" && !std::filesystem::is_directory(place)) {
            found = place.string();
            return;
        }
        const auto files = list_checkpoints(place);
        if (files.empty())
            throw std::runtime_error(fmt::format("{}: no checkpoint in this folder", place.string()));
        found = files.front().string();
    });
    return comm.all_broadcast(std::move(found));
}

}  // namespace talus
