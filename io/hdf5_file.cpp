#include "io/hdf5_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "io/file_info.hpp"

namespace talus::hdf5 {
namespace {

/// The innermost message of HDF5's error stack, which names the cause.
std::string reason() {
    std::string text;
    const auto visit = [](unsigned, const H5E_error2_t* error, void* data) -> herr_t {
        if (error->desc != nullptr && error->desc[0] != '\0') *static_cast<std::string*>(data) = error->desc;
        return 0;
    };
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, visit, &text);
    return text.empty() ? "HDF5 gives no reason" : text;
}

void be_quiet() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

Handle property_list(hid_t kind) { return Handle(H5Pcreate(kind), H5Pclose, "make a property list"); }

Handle scalar_space() { return Handle(H5Screate(H5S_SCALAR), H5Sclose, "make a data space"); }

Handle access_list() {
    be_quiet();
    Handle access = property_list(H5P_FILE_ACCESS);
    check(H5Pset_file_locking(access, false, true), "set file locking");
    check(H5Pset_fclose_degree(access, H5F_CLOSE_STRONG), "set the close degree");
    return access;
}

Handle text_type() {
    Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "make a text type");
    check(H5Tset_size(type, H5T_VARIABLE), "make a text type");
    check(H5Tset_cset(type, H5T_CSET_UTF8), "make a text type");
    return type;
}

Handle fixed_text_type(std::size_t size, H5T_cset_t characters) {
    Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "make a text type");
    check(H5Tset_size(type, std::max<std::size_t>(size, 1)), "make a text type");
    check(H5Tset_strpad(type, H5T_STR_NULLPAD), "make a text type");
    check(H5Tset_cset(type, characters), "make a text type");
    return type;
}

void write_attribute(hid_t object, const std::string& name, hid_t type, hid_t space, const void* value) {
    const Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                           "make attribute " + name);
    check(H5Awrite(attribute, type, value), "write attribute " + name);
}

void write_attribute(hid_t object, const std::string& name, hid_t type, std::size_t count,
                     const void* values) {
    const hsize_t extent = count;
    const Handle space(H5Screate_simple(1, &extent, nullptr), H5Sclose, "make a data space");
    write_attribute(object, name, type, space, values);
}

void read_number(hid_t object, const std::string& name, H5T_class_t kind, hid_t type, void* value) {
    const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, "open attribute " + name);
    const Handle space(H5Aget_space(attribute), H5Sclose, "examine attribute " + name);
    const Handle found(H5Aget_type(attribute), H5Tclose, "examine attribute " + name);
    if (H5Sget_simple_extent_npoints(space) != 1 || H5Tget_class(found) != kind)
        throw std::runtime_error(fmt::format("attribute {} is not one number", name));
    check(H5Aread(attribute, type, value), "read attribute " + name);
}

/// Reads a text of fixed or variable length through `read(type, buffer)`.
template <class Read>
std::string read_any_text(hid_t found, hid_t space, const Read& read, const std::string& name) {
    if (H5Tget_class(found) != H5T_STRING || H5Sget_simple_extent_npoints(space) != 1)
        throw std::runtime_error(fmt::format("{} is not a text", name));
    if (H5Tis_variable_str(found) > 0) {
        char* words = nullptr;
        const Handle type = text_type();
        check(H5Tset_cset(type, H5Tget_cset(found)), "read " + name);
        check(read(static_cast<hid_t>(type), &words), "read " + name);
        std::string text = words == nullptr ? std::string() : std::string(words);
        H5free_memory(words);
        return text;
    }
    std::string text(H5Tget_size(found), '\0');
    check(read(found, text.data()), "read " + name);
    return text.substr(0, text.find('\0'));
}

}  // namespace

namespace {
bool stuck = false;
}

Handle::Handle(hid_t id, herr_t (*closer)(hid_t), std::string_view what) : id_(id), close_(closer) {
    if (id < 0) throw std::runtime_error(fmt::format("cannot {} ({})", what, reason()));
}

void Handle::close(std::string_view what) {
    const hid_t id = std::exchange(id_, -1);
    if (id < 0) return;
    const herr_t status = close_(id);
    stuck = stuck || status < 0;
    check(status, what);
}

void Handle::reset() {
    const hid_t id = std::exchange(id_, -1);
    if (id >= 0 && close_(id) < 0) stuck = true;
}

void check(herr_t status, std::string_view what) {
    if (status < 0) throw std::runtime_error(fmt::format("cannot {} ({})", what, reason()));
}

hid_t native_type(ValueType type) {
    switch (type) {
        case ValueType::f64:
            return H5T_NATIVE_DOUBLE;
        case ValueType::f32:
            return H5T_NATIVE_FLOAT;
        case ValueType::u64:
            return H5T_NATIVE_UINT64;
        case ValueType::u32:
            return H5T_NATIVE_UINT32;
        case ValueType::u8:
            return H5T_NATIVE_UINT8;
    }
    return -1;
}

std::optional<ValueType> value_type(hid_t type) {
    for (const ValueType known :
         {ValueType::f64, ValueType::f32, ValueType::u64, ValueType::u32, ValueType::u8})
        if (H5Tequal(type, native_type(known)) > 0) return known;
    return {};
}

Handle create_file(const std::filesystem::path& file, std::uint64_t user_block) {
    const Handle access = access_list();
    check(H5Pset_alignment(access, 1 << 16, 1 << 12), "set the alignment");  // large datasets begin on a page
    const Handle creation = property_list(H5P_FILE_CREATE);
    check(H5Pset_userblock(creation, user_block), "set the user block");
    return Handle(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, creation, access), H5Fclose,
                  fmt::format("create {}", file.string()));
}

Handle open_file(const std::filesystem::path& file, bool writable) {
    const Handle access = access_list();
    return Handle(H5Fopen(file.c_str(), writable ? H5F_ACC_RDWR : H5F_ACC_RDONLY, access), H5Fclose,
                  fmt::format("open {}", file.string()));
}

Handle create_group(hid_t parent, const std::string& path) {
    const Handle links = property_list(H5P_LINK_CREATE);
    check(H5Pset_create_intermediate_group(links, 1), "make group " + path);
    return Handle(H5Gcreate2(parent, path.c_str(), links, H5P_DEFAULT, H5P_DEFAULT), H5Gclose,
                  "make group " + path);
}

Handle open_group(hid_t parent, const std::string& path) {
    return Handle(H5Gopen2(parent, path.c_str(), H5P_DEFAULT), H5Gclose, "open group " + path);
}

Handle create_dataset(hid_t parent, const std::string& path, ValueType type, std::uint64_t rows,
                      std::size_t components) {
    const Handle creation = property_list(H5P_DATASET_CREATE);
    check(H5Pset_layout(creation, H5D_CONTIGUOUS), "make dataset " + path);
    check(H5Pset_alloc_time(creation, H5D_ALLOC_TIME_EARLY), "make dataset " + path);
    check(H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER), "make dataset " + path);
    check(H5Pset_obj_track_times(creation, false), "make dataset " + path);
    const hsize_t extent[2] = {rows, components};
    const Handle space(H5Screate_simple(components > 1 ? 2 : 1, extent, nullptr), H5Sclose,
                       "make dataset " + path);
    return Handle(
        H5Dcreate2(parent, path.c_str(), native_type(type), space, H5P_DEFAULT, creation, H5P_DEFAULT),
        H5Dclose, "make dataset " + path);
}

Handle open_dataset(hid_t parent, const std::string& path) {
    return Handle(H5Dopen2(parent, path.c_str(), H5P_DEFAULT), H5Dclose, "open dataset " + path);
}

void write_text(hid_t parent, const std::string& path, const std::string& text) {
    const Handle creation = property_list(H5P_DATASET_CREATE);
    check(H5Pset_obj_track_times(creation, false), "make dataset " + path);
    const Handle type = fixed_text_type(text.size(), H5T_CSET_UTF8);
    const Handle space = scalar_space();
    const Handle dataset(H5Dcreate2(parent, path.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT),
                         H5Dclose, "make dataset " + path);
    check(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()), "write dataset " + path);
}

std::string read_text(hid_t parent, const std::string& path) {
    const Handle dataset = open_dataset(parent, path);
    const Handle found(H5Dget_type(dataset), H5Tclose, "examine dataset " + path);
    const Handle space(H5Dget_space(dataset), H5Sclose, "examine dataset " + path);
    const auto read = [&](hid_t type, void* to) {
        return H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, to);
    };
    return read_any_text(found, space, read, path);
}

void set_attribute(hid_t object, const std::string& name, double value) {
    write_attribute(object, name, H5T_NATIVE_DOUBLE, scalar_space(), &value);
}
void set_attribute(hid_t object, const std::string& name, std::uint64_t value) {
    write_attribute(object, name, H5T_NATIVE_UINT64, scalar_space(), &value);
}
void set_attribute(hid_t object, const std::string& name, const std::string& value) {
    const char* words = value.c_str();
    write_attribute(object, name, text_type(), scalar_space(), &words);
}
void set_attribute(hid_t object, const std::string& name, std::span<const std::int64_t> values) {
    write_attribute(object, name, H5T_NATIVE_INT64, values.size(), values.data());
}
void set_attribute(hid_t object, const std::string& name, std::span<const double> values) {
    write_attribute(object, name, H5T_NATIVE_DOUBLE, values.size(), values.data());
}
void set_fixed_text(hid_t object, const std::string& name, std::string_view value) {
    const Handle type = fixed_text_type(value.size(), H5T_CSET_ASCII);
    write_attribute(object, name, type, scalar_space(), std::string(value).c_str());
}

void change_attribute(hid_t object, const std::string& name, std::uint64_t value) {
    const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, "open attribute " + name);
    check(H5Awrite(attribute, H5T_NATIVE_UINT64, &value), "write attribute " + name);
}

bool has_attribute(hid_t object, const std::string& name) { return H5Aexists(object, name.c_str()) > 0; }

double double_attribute(hid_t object, const std::string& name) {
    double value = 0;
    read_number(object, name, H5T_FLOAT, H5T_NATIVE_DOUBLE, &value);
    return value;
}

std::uint64_t integer_attribute(hid_t object, const std::string& name) {
    std::uint64_t value = 0;
    read_number(object, name, H5T_INTEGER, H5T_NATIVE_UINT64, &value);
    return value;
}

std::string text_attribute(hid_t object, const std::string& name) {
    const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, "open attribute " + name);
    const Handle found(H5Aget_type(attribute), H5Tclose, "examine attribute " + name);
    const Handle space(H5Aget_space(attribute), H5Sclose, "examine attribute " + name);
    const auto read = [&](hid_t type, void* to) { return H5Aread(attribute, type, to); };
    return read_any_text(found, space, read, "attribute " + name);
}

std::vector<std::string> attribute_names(hid_t object) {
    std::vector<std::string> names;
    const auto visit = [](hid_t, const char* name, const H5A_info_t*, void* data) -> herr_t {
        static_cast<std::vector<std::string>*>(data)->emplace_back(name);
        return 0;
    };
    check(H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, visit, &names), "list attributes");
    return names;
}

std::vector<std::string> children(hid_t group) {
    std::vector<std::string> names;
    const auto visit = [](hid_t, const char* name, const H5L_info_t*, void* data) -> herr_t {
        static_cast<std::vector<std::string>*>(data)->emplace_back(name);
        return 0;
    };
    check(H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, visit, &names), "list a group");
    return names;
}

Extent extent_of(hid_t dataset) {
    const Handle creation(H5Dget_create_plist(dataset), H5Pclose, "examine a dataset");
    const Handle type(H5Dget_type(dataset), H5Tclose, "examine a dataset");
    const Handle space(H5Dget_space(dataset), H5Sclose, "examine a dataset");
    const std::optional<ValueType> known = value_type(type);
    const int rank = H5Sget_simple_extent_ndims(space);
    if (!known || rank < 1 || rank > 2 || H5Pget_layout(creation) != H5D_CONTIGUOUS)
        throw std::runtime_error("not a contiguous array of a known type");
    hsize_t extent[2] = {0, 1};
    check(H5Sget_simple_extent_dims(space, extent, nullptr), "examine a dataset");
    Extent made{*known, extent[0], extent[1], 0};
    if (made.rows == 0) return made;
    const haddr_t offset = H5Dget_offset(dataset);
    if (offset == HADDR_UNDEF || H5Dget_storage_size(dataset) != made.rows * made.row_bytes())
        throw std::runtime_error("its data are not in the file");
    made.offset = offset;
    return made;
}

}  // namespace talus::hdf5

namespace talus {
bool files_are_stuck() { return hdf5::stuck; }
}  // namespace talus
