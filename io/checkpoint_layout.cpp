#include "io/checkpoint_layout.hpp"

#include <fmt/format.h>

#include <cstring>
#include <stdexcept>

#include "io/file_guard.hpp"
#include "io/hashing.hpp"
#include "io/particle_file.hpp"

namespace talus {
namespace {

std::uint64_t checksum_of(const RunState& state) {
    Hasher64 hash;
    hash.add(state.time);
    hash.add(state.time_step);
    hash.add(state.step);
    hash.add(std::string_view(state.version));
    for (const auto& [name, value] : state.numbers) {
        hash.add(std::string_view(name));
        hash.add(value);
    }
    for (const std::string& name : state.materials) hash.add(std::string_view(name));
    for (const std::string& name : state.walls) hash.add(std::string_view(name));
    return hash.value();
}

void write_checked_text(hid_t file, const std::string& path, const std::string& text) {
    hdf5::write_text(file, path, text);
    const hdf5::Handle dataset = hdf5::open_dataset(file, path);
    hdf5::set_attribute(dataset, "xxh64", hash64(text));
}

std::string read_checked_text(hid_t file, const std::string& path) {
    std::string text = hdf5::read_text(file, path);
    const hdf5::Handle dataset = hdf5::open_dataset(file, path);
    if (hash64(text) != hdf5::integer_attribute(dataset, "xxh64"))
        throw std::runtime_error("checksum does not match");
    return text;
}

std::string material_attribute(std::uint64_t body) { return fmt::format("material_{}", body); }
std::string wall_attribute(std::uint64_t wall) { return fmt::format("wall_{}", wall); }

RunState read_run_state(hid_t file) {
    RunState state;
    const hdf5::Handle group = hdf5::open_group(file, "/state");
    state.time = hdf5::double_attribute(group, "time");
    state.time_step = hdf5::double_attribute(group, "time_step");
    state.step = hdf5::integer_attribute(group, "step");
    state.version = hdf5::text_attribute(group, "version");
    const hdf5::Handle numbers = hdf5::open_group(file, "/state/numbers");
    for (const std::string& name : hdf5::attribute_names(numbers))
        state.numbers[name] = hdf5::double_attribute(numbers, name);
    if (hdf5::has_attribute(group, "bodies"))  // not in files of the first programs
        for (std::uint64_t b = 0; b < hdf5::integer_attribute(group, "bodies"); ++b)
            state.materials.push_back(hdf5::text_attribute(group, material_attribute(b)));
    while (hdf5::has_attribute(group, wall_attribute(state.walls.size())))
        state.walls.push_back(hdf5::text_attribute(group, wall_attribute(state.walls.size())));
    if (checksum_of(state) != hdf5::integer_attribute(group, "xxh64"))
        throw std::runtime_error("checksum does not match");
    return state;
}

StoredField read_field(hid_t group, const std::string& name) {
    StoredField field;
    field.name = name;
    const hdf5::Handle dataset = hdf5::open_dataset(group, name);
    field.extent = hdf5::extent_of(dataset);
    field.checksum = hdf5::integer_attribute(dataset, checksum_attribute);
    field.unit = hdf5::text_attribute(dataset, "units");
    if (hdf5::integer_attribute(dataset, "rows_per_block") != rows_per_block)
        throw std::runtime_error("rows_per_block is not ours");
    return field;
}

/// Names what an action was about if it fails.
template <class Action>
auto in_section(const std::string& section, const Action& action) {
    try {
        return action();
    } catch (const std::exception& failure) {
        throw std::runtime_error(fmt::format("{}: {}", section, failure.what()));
    }
}

StoredSet read_set(hid_t file, const std::string& name) {
    StoredSet set;
    set.name = name;
    const std::string path = "/sets/" + name;
    return in_section(path, [&] {
        const hdf5::Handle group = hdf5::open_group(file, path);
        set.dimension = static_cast<int>(hdf5::integer_attribute(group, "dimension"));
        set.count = hdf5::integer_attribute(group, "count");
        for (const std::string& field : hdf5::children(group)) {
            set.fields.push_back(in_section(field, [&] { return read_field(group, field); }));
            if (set.fields.back().extent.rows != set.count)
                throw std::runtime_error(fmt::format("{}: {} rows instead of {}", field,
                                                     set.fields.back().extent.rows, set.count));
        }
        if (set.fields.size() != hdf5::integer_attribute(group, "fields"))
            throw std::runtime_error("a field is missing");
        return set;
    });
}

class Packer {
  public:
    void add(std::uint64_t value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); }
    void add(double value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); }
    void add(const std::string& text) {
        add(static_cast<std::uint64_t>(text.size()));
        bytes += text;
    }
    std::string bytes;
};

class Unpacker {
  public:
    explicit Unpacker(const std::string& bytes) : bytes_(bytes) {}
    std::uint64_t integer() { return take<std::uint64_t>(); }
    double real() { return take<double>(); }
    std::string text() {
        const std::uint64_t size = integer();
        at_ += size;
        return bytes_.substr(at_ - size, size);
    }

  private:
    template <class T>
    T take() {
        T value;
        std::memcpy(&value, bytes_.data() + at_, sizeof value);
        at_ += sizeof value;
        return value;
    }
    const std::string& bytes_;
    std::size_t at_ = 0;
};

}  // namespace

void write_run_state(hid_t file, const RunState& state) {
    hdf5::set_attribute(file, "format", std::string(checkpoint_format));
    hdf5::set_attribute(file, "format_version", checkpoint_format_version);
    const hdf5::Handle group = hdf5::create_group(file, "/state");
    hdf5::set_attribute(group, "time", state.time);
    hdf5::set_attribute(group, "time_step", state.time_step);
    hdf5::set_attribute(group, "step", state.step);
    hdf5::set_attribute(group, "version", state.version);
    const hdf5::Handle numbers = hdf5::create_group(file, "/state/numbers");
    for (const auto& [name, value] : state.numbers) hdf5::set_attribute(numbers, name, value);
    if (!state.materials.empty())
        hdf5::set_attribute(group, "bodies", static_cast<std::uint64_t>(state.materials.size()));
    for (std::size_t b = 0; b < state.materials.size(); ++b)
        hdf5::set_attribute(group, material_attribute(b), state.materials[b]);
    for (std::size_t w = 0; w < state.walls.size(); ++w)
        hdf5::set_attribute(group, wall_attribute(w), state.walls[w]);
    hdf5::set_attribute(group, "xxh64", checksum_of(state));
    write_checked_text(file, "/scene", state.scene_text);
    write_checked_text(file, "/resolved_scene", state.resolved_scene);
}

CheckpointLayout read_layout(const std::filesystem::path& path) {
    return in_section(path.string(), [&] {
        check_guard(path);
        const hdf5::Handle file = hdf5::open_file(path, false);
        if (hdf5::text_attribute(file, "format") != checkpoint_format)
            throw std::runtime_error("not a checkpoint of Talus");
        if (const auto version = hdf5::integer_attribute(file, "format_version");
            version != checkpoint_format_version)
            throw std::runtime_error(
                fmt::format("format version {}, this program reads {}", version, checkpoint_format_version));
        CheckpointLayout layout;
        layout.state = in_section("/state", [&] { return read_run_state(file); });
        layout.state.scene_text = in_section("/scene", [&] { return read_checked_text(file, "/scene"); });
        layout.state.resolved_scene =
            in_section("/resolved_scene", [&] { return read_checked_text(file, "/resolved_scene"); });
        in_section("/sets", [&] {
            const hdf5::Handle sets = hdf5::open_group(file, "/sets");
            for (const std::string& name : hdf5::children(sets)) layout.sets.push_back(read_set(file, name));
            if (layout.sets.size() != hdf5::integer_attribute(sets, "count"))
                throw std::runtime_error("a particle set is missing");
        });
        return layout;
    });
}

std::string serialized(const CheckpointLayout& layout) {
    Packer out;
    const RunState& state = layout.state;
    out.add(state.time);
    out.add(state.time_step);
    out.add(state.step);
    for (const std::string& text : {state.version, state.scene_text, state.resolved_scene}) out.add(text);
    out.add(static_cast<std::uint64_t>(state.numbers.size()));
    for (const auto& [name, value] : state.numbers) {
        out.add(name);
        out.add(value);
    }
    out.add(static_cast<std::uint64_t>(state.materials.size()));
    for (const std::string& name : state.materials) out.add(name);
    out.add(static_cast<std::uint64_t>(state.walls.size()));
    for (const std::string& name : state.walls) out.add(name);
    out.add(static_cast<std::uint64_t>(layout.sets.size()));
    for (const StoredSet& set : layout.sets) {
        out.add(set.name);
        for (const std::uint64_t value : {static_cast<std::uint64_t>(set.dimension), set.count,
                                          static_cast<std::uint64_t>(set.fields.size())})
            out.add(value);
        for (const StoredField& field : set.fields) {
            out.add(field.name);
            out.add(field.unit);
            for (const std::uint64_t value :
                 {static_cast<std::uint64_t>(field.extent.type), field.extent.rows,
                  static_cast<std::uint64_t>(field.extent.components), field.extent.offset, field.checksum})
                out.add(value);
        }
    }
    return out.bytes;
}

CheckpointLayout deserialized(const std::string& bytes) {
    Unpacker in(bytes);
    CheckpointLayout layout;
    RunState& state = layout.state;
    state.time = in.real();
    state.time_step = in.real();
    state.step = in.integer();
    state.version = in.text();
    state.scene_text = in.text();
    state.resolved_scene = in.text();
    for (std::uint64_t left = in.integer(); left > 0; --left) {
        std::string name = in.text();
        state.numbers[std::move(name)] = in.real();
    }
    state.materials.resize(in.integer());
    for (std::string& name : state.materials) name = in.text();
    state.walls.resize(in.integer());
    for (std::string& name : state.walls) name = in.text();
    layout.sets.resize(in.integer());
    for (StoredSet& set : layout.sets) {
        set.name = in.text();
        set.dimension = static_cast<int>(in.integer());
        set.count = in.integer();
        set.fields.resize(in.integer());
        for (StoredField& field : set.fields) {
            field.name = in.text();
            field.unit = in.text();
            field.extent.type = static_cast<ValueType>(in.integer());
            field.extent.rows = in.integer();
            field.extent.components = in.integer();
            field.extent.offset = in.integer();
            field.checksum = in.integer();
        }
    }
    return layout;
}

}  // namespace talus
