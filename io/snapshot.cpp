#include "io/snapshot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstring>
#include <fstream>
#include <numeric>
#include <utility>

#include "io/durable.hpp"
#include "io/particle_file.hpp"

namespace talus {
namespace {

constexpr std::pair<const FieldInfo*, std::string_view> names[] = {
    {&field::position, "Coordinates"},
    {&field::velocity, "Velocities"},
    {&field::id, "ParticleIDs"},
    {&field::mass, "Masses"},
    {&field::density, "Densities"},
    {&field::smoothing_length, "SmoothingLengths"},
    {&field::pressure, "Pressures"},
    {&field::internal_energy, "InternalEnergies"},
    {&field::deviatoric_stress, "StressDeviator"},
    {&field::body, "BodyIDs"},
};

/// Which stored component each written one is, -1 for zero.
struct Arrangement {
    std::vector<int> sources;
    bool traceless = false;  ///< missing diagonal components make the trace vanish
};

Arrangement arrangement(const Column& values, int dimension) {
    const FieldInfo& info = *values.info;
    Arrangement made;
    switch (info.shape) {
        case Shape::scalar:
            made.sources = {0};
            break;
        case Shape::vector:
        case Shape::point:
            for (int axis = 0; axis < 3; ++axis) made.sources.push_back(axis < dimension ? axis : -1);
            break;
        case Shape::symmetric_tensor:
            made.sources = dimension == 3   ? std::vector<int>{0, 1, 2, 3, 5, 4}
                           : dimension == 2 ? std::vector<int>{0, 1, -1, 2, -1, -1}
                                            : std::vector<int>{0, -1, -1, -1, -1, -1};
            made.traceless = &info == &field::deviatoric_stress || &info == &field::predicted_stress;
            break;
        case Shape::tensor:
            for (int row = 0; row < 3; ++row)
                for (int column = 0; column < 3; ++column)
                    made.sources.push_back(row < dimension && column < dimension ? row * dimension + column
                                                                                 : -1);
            break;
        case Shape::profile:
            made.sources.resize(values.components.size());
            std::iota(made.sources.begin(), made.sources.end(), 0);
            break;
    }
    return made;
}

template <class Stored, class Written>
void pack_as(const Column& column, std::span<const std::uint32_t> order, const Arrangement& parts,
             int dimension, std::vector<std::byte>& rows) {
    const auto value = [&](int component, std::uint32_t particle) {
        Stored stored;
        std::memcpy(&stored,
                    column.components[static_cast<std::size_t>(component)].data() + particle * sizeof stored,
                    sizeof stored);
        return stored;
    };
    rows.resize(order.size() * parts.sources.size() * sizeof(Written));
    std::byte* to = rows.data();
    for (const std::uint32_t particle : order) {
        for (std::size_t k = 0; k < parts.sources.size(); ++k, to += sizeof(Written)) {
            Stored stored{};
            if (parts.sources[k] >= 0) {
                stored = value(parts.sources[k], particle);
            } else if (parts.traceless && k < 3) {
                for (int axis = 0; axis < dimension; ++axis)
                    stored = static_cast<Stored>(stored -
                                                 value(axis, particle) / static_cast<Stored>(3 - dimension));
            }
            const auto written = static_cast<Written>(stored);
            std::memcpy(to, &written, sizeof written);
        }
    }
}

std::vector<std::byte> packed(const Column& column, ValueType as, std::span<const std::uint32_t> order,
                              int dimension) {
    std::vector<std::byte> rows;
    const Arrangement parts = arrangement(column, dimension);
    switch (column.info->type) {
        case ValueType::f64:
            if (as == ValueType::f32)
                pack_as<double, float>(column, order, parts, dimension, rows);
            else
                pack_as<double, double>(column, order, parts, dimension, rows);
            break;
        case ValueType::f32:
            pack_as<float, float>(column, order, parts, dimension, rows);
            break;
        case ValueType::u64:
            pack_as<std::uint64_t, std::uint64_t>(column, order, parts, dimension, rows);
            break;
        case ValueType::u32:
            pack_as<std::uint32_t, std::uint32_t>(column, order, parts, dimension, rows);
            break;
        case ValueType::u8:
            pack_as<std::uint8_t, std::uint8_t>(column, order, parts, dimension, rows);
            break;
    }
    return rows;
}

DatasetPlan plan_field(const ParticleSet& set, const IdOrder& order, const SnapshotField& wanted) {
    const Column& column = set.column(*wanted.field);
    DatasetPlan plan;
    plan.path = "/PartType0/" + (wanted.name.empty() ? snapshot_name(*wanted.field) : wanted.name);
    plan.type =
        wanted.single_precision && column.info->type == ValueType::f64 ? ValueType::f32 : column.info->type;
    plan.total = order.total();
    plan.components = arrangement(column, set.dimension()).sources.size();
    plan.unit = column.info->unit;
    plan.description =
        wanted.description.empty() ? std::string(column.info->description) : wanted.description;
    plan.rows = order.rows();
    plan.data = [&column, &order, &set, type = plan.type, row_bytes = plan.row_bytes()](std::uint64_t slab) {
        return order.exchange(slab, row_bytes, [&](std::span<const std::uint32_t> particles) {
            return packed(column, type, particles, set.dimension());
        });
    };
    return plan;
}

/// VTK wants a cell for each particle: Offsets is 0, 1, ..., N, and serves as Connectivity, too.
DatasetPlan plan_offsets(const Communicator& comm, std::uint64_t total) {
    DatasetPlan plan;
    plan.path = "/VTKHDF/Offsets";
    plan.type = ValueType::u64;
    plan.total = total + 1;
    plan.unit = std::string("1");
    plan.description = "first point of each VTK cell";
    plan.rows = rows_of_rank(plan.total, comm.rank(), comm.size());
    plan.data = [rows = plan.rows](std::uint64_t slab) {
        const RowRange range = slab_of(rows, slab);
        std::vector<std::byte> bytes(range.count() * sizeof(std::uint64_t));
        for (std::uint64_t row = range.begin; row < range.end; ++row)
            std::memcpy(bytes.data() + (row - range.begin) * sizeof row, &row, sizeof row);
        return bytes;
    };
    return plan;
}

void link(hid_t file, const std::string& from, const std::string& to) {
    hdf5::check(H5Lcreate_hard(file, from.c_str(), file, to.c_str(), H5P_DEFAULT, H5P_DEFAULT), "link " + to);
}

void write_small(hid_t file, const std::string& path, hid_t type, const void* value) {
    const hsize_t one = 1;
    const hdf5::Handle space(H5Screate_simple(1, &one, nullptr), H5Sclose, "make " + path);
    const hdf5::Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "make " + path);
    hdf5::check(H5Pset_obj_track_times(creation, false), "make " + path);
    const hdf5::Handle made(H5Dcreate2(file, path.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT),
                            H5Dclose, "make " + path);
    hdf5::check(H5Dwrite(made, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, value), "write " + path);
}

/// Every particle is a VTK_VERTEX: a dataset that is all fill value takes no room.
void write_types(hid_t file, std::uint64_t total) {
    const std::uint8_t vertex = 1;
    const hsize_t extent = total;
    const hdf5::Handle space(H5Screate_simple(1, &extent, nullptr), H5Sclose, "make Types");
    const hdf5::Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "make Types");
    hdf5::check(H5Pset_fill_value(creation, H5T_NATIVE_UINT8, &vertex), "make Types");
    hdf5::check(H5Pset_alloc_time(creation, H5D_ALLOC_TIME_LATE), "make Types");
    hdf5::check(H5Pset_obj_track_times(creation, false), "make Types");
    const hdf5::Handle made(
        H5Dcreate2(file, "/VTKHDF/Types", H5T_STD_U8LE, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose,
        "make Types");
}

void write_header(hid_t file, const RunState& state, const ParticleSet& set, std::uint64_t total) {
    hdf5::set_attribute(file, "format", std::string("talus-snapshot"));
    hdf5::set_attribute(file, "format_version", std::uint64_t{1});
    hdf5::set_attribute(file, "code", std::string("talus"));
    hdf5::set_attribute(file, "code_version", state.version);
    const hdf5::Handle header = hdf5::create_group(file, "/Header");
    const std::array<std::int64_t, 6> none{}, count{static_cast<std::int64_t>(total & 0xffffffffU)},
        high{static_cast<std::int64_t>(total >> 32U)}, here{static_cast<std::int64_t>(total)};
    const std::array<double, 6> no_mass{};
    hdf5::set_attribute(header, "NumPart_ThisFile", here);
    hdf5::set_attribute(header, "NumPart_Total", count);
    hdf5::set_attribute(header, "NumPart_Total_HighWord", high);
    hdf5::set_attribute(header, "MassTable", no_mass);
    hdf5::set_attribute(header, "Flag_Entropy_ICs", none);
    hdf5::set_attribute(header, "NumFilesPerSnapshot", std::uint64_t{1});
    hdf5::set_attribute(header, "Time", state.time);
    hdf5::set_attribute(header, "TimeStep", state.time_step);
    hdf5::set_attribute(header, "Step", state.step);
    hdf5::set_attribute(header, "Redshift", 0.0);
    hdf5::set_attribute(header, "Dimension", static_cast<std::uint64_t>(set.dimension()));
    hdf5::set_attribute(header, "ParticleSet", set.name());
    const hdf5::Handle numbers = hdf5::create_group(file, "/Header/numbers");
    for (const auto& [name, value] : state.numbers) hdf5::set_attribute(numbers, name, value);
    const hdf5::Handle units = hdf5::create_group(file, "/Units");
    for (const char* name : {"length_si", "mass_si", "time_si", "temperature_si"})
        hdf5::set_attribute(units, name, 1.0);
    hdf5::write_text(file, "/Scene", state.scene_text);
    hdf5::write_text(file, "/ResolvedScene", state.resolved_scene);
}

/// The VTKHDF 1.0 view: hard links to the particle data.
void write_view(hid_t file, double time, std::uint64_t total, const std::vector<DatasetPlan>& datasets) {
    const hdf5::Handle view = hdf5::open_group(file, "/VTKHDF");
    hdf5::set_attribute(view, "Version", std::array<std::int64_t, 2>{1, 0});
    hdf5::set_fixed_text(view, "Type", "UnstructuredGrid");
    const auto count = static_cast<std::int64_t>(total);
    for (const char* name :
         {"/VTKHDF/NumberOfPoints", "/VTKHDF/NumberOfCells", "/VTKHDF/NumberOfConnectivityIds"})
        write_small(file, name, H5T_NATIVE_INT64, &count);
    write_types(file, total);
    link(file, "/VTKHDF/Offsets", "/VTKHDF/Connectivity");
    link(file, "/PartType0/Coordinates", "/VTKHDF/Points");
    const hdf5::Handle data = hdf5::create_group(file, "/VTKHDF/PointData");
    for (const DatasetPlan& dataset : datasets) {
        const std::string name = dataset.path.substr(dataset.path.rfind('/') + 1);
        if (dataset.path.starts_with("/PartType0/") && name != "Coordinates")
            link(file, dataset.path, "/VTKHDF/PointData/" + name);
    }
    const hdf5::Handle field_data = hdf5::create_group(file, "/VTKHDF/FieldData");
    write_small(file, "/VTKHDF/FieldData/TimeValue", H5T_NATIVE_DOUBLE, &time);
}

/// Entries {name, time} of a series file that we wrote, one a line.
std::vector<std::pair<std::string, double>> read_series(const std::filesystem::path& series) {
    std::vector<std::pair<std::string, double>> entries;
    std::ifstream stream(series);
    std::string line;
    while (std::getline(stream, line)) {
        constexpr std::string_view start = R"(    {"name": ")", middle = R"(", "time": )";
        const auto end = line.find(middle);
        if (!line.starts_with(start) || end == std::string::npos) continue;
        double time = 0;
        const char* const number = line.data() + end + middle.size();
        if (std::from_chars(number, line.data() + line.size(), time).ec == std::errc())
            entries.emplace_back(line.substr(start.size(), end - start.size()), time);
    }
    return entries;
}

/// Adds a snapshot to the series; those of the same or a later time, from a run that was restarted, go.
void add_to_series(const std::filesystem::path& file, const std::filesystem::path& series, double time) {
    auto entries = read_series(series);
    const std::string name = file.filename().string();
    std::erase_if(entries, [&](const auto& entry) { return entry.second >= time || entry.first >= name; });
    entries.emplace_back(name, time);
    std::vector<std::string> lines;
    lines.reserve(entries.size());
    for (const auto& [entry, when] : entries)
        lines.push_back(fmt::format(R"(    {{"name": "{}", "time": {}}})", entry, when));
    replace_file(series, fmt::format("{{\n  \"file-series-version\": \"1.0\",\n  \"files\": [\n{}\n  ]\n}}\n",
                                     fmt::join(lines, ",\n")));
}

}  // namespace

std::string snapshot_name(const FieldInfo& field) {
    for (const auto& [known, name] : names)
        if (known == &field) return std::string(name);
    std::string name;
    bool capital = true;
    for (const char c : field.name) {
        if (c != '_') name += capital ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
        capital = c == '_';
    }
    return name;
}

void write_snapshot(const Communicator& comm, const std::filesystem::path& directory, std::uint64_t index,
                    const RunState& state, const ParticleSet& set, const std::vector<SnapshotField>& fields) {
    const IdOrder order(comm, set.own(field::id), set.name());
    ParticleFilePlan plan;
    plan.file = directory / fmt::format("{}_{:06}.hdf", set.name(), index);
    plan.datasets.push_back(plan_field(set, order, {&field::position}));
    plan.datasets.push_back(plan_field(set, order, {&field::id}));
    for (const SnapshotField& wanted : fields)
        if (wanted.field != &field::position && wanted.field != &field::id)
            plan.datasets.push_back(plan_field(set, order, wanted));
    plan.datasets.push_back(plan_offsets(comm, order.total()));
    plan.describe = [&](hid_t file) {
        write_header(file, state, set, order.total());
        write_view(file, state.time, order.total(), plan.datasets);
        link(file, "/PartType0", "/" + set.name());
    };
    write_particle_file(comm, plan);
    agree_on_root(comm,
                  [&] { add_to_series(plan.file, directory / (set.name() + ".hdf.series"), state.time); });
}

}  // namespace talus
