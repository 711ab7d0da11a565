#pragma once
#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "domain/fields.hpp"

/// Thin, throwing cover of the HDF5 functions that Talus uses, on one rank. Inside of io/.
namespace talus::hdf5 {

/// Owns any HDF5 identifier. Constructed from a function's result; throws std::runtime_error if that failed.
class Handle {
  public:
    Handle(hid_t id, herr_t (*closer)(hid_t), std::string_view what);
    ~Handle() { reset(); }
    Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
    Handle& operator=(Handle&& other) noexcept {
        reset();
        id_ = std::exchange(other.id_, -1);
        close_ = other.close_;
        return *this;
    }
    operator hid_t() const { return id_; }
    /// Closes and throws if that failed: data may have been lost.
    void close(std::string_view what);

  private:
    void reset();
    hid_t id_;
    herr_t (*close_)(hid_t);
};

/// Throws std::runtime_error "cannot <what> (<HDF5's reason>)" if `status` is negative.
void check(herr_t status, std::string_view what);

/// HDF5's own type for our values.
hid_t native_type(ValueType type);
/// The reverse; nothing if it is none of ours.
std::optional<ValueType> value_type(hid_t type);

/// Files are locked neither for reading nor for writing: the names they are written under are nobody else's.
/// The first `user_block` bytes are left free (0, or a power of two from 512 on).
Handle create_file(const std::filesystem::path& file, std::uint64_t user_block = 0);
Handle open_file(const std::filesystem::path& file, bool writable);
Handle create_group(hid_t parent, const std::string& path);
Handle open_group(hid_t parent, const std::string& path);

/// A contiguous dataset [rows] or, if components > 1, [rows, components], allocated at once, not filled.
Handle create_dataset(hid_t parent, const std::string& path, ValueType type, std::uint64_t rows,
                      std::size_t components);
Handle open_dataset(hid_t parent, const std::string& path);
/// A text of fixed length as a dataset of one element.
void write_text(hid_t parent, const std::string& path, const std::string& text);
std::string read_text(hid_t parent, const std::string& path);

void set_attribute(hid_t object, const std::string& name, double value);
void set_attribute(hid_t object, const std::string& name, std::uint64_t value);
void set_attribute(hid_t object, const std::string& name, const std::string& value);
void set_attribute(hid_t object, const std::string& name, std::span<const std::int64_t> values);
void set_attribute(hid_t object, const std::string& name, std::span<const double> values);
/// Of fixed length, as VTK wants it.
void set_fixed_text(hid_t object, const std::string& name, std::string_view value);
/// Changes the value of an existing attribute.
void change_attribute(hid_t object, const std::string& name, std::uint64_t value);

bool has_attribute(hid_t object, const std::string& name);
double double_attribute(hid_t object, const std::string& name);
std::uint64_t integer_attribute(hid_t object, const std::string& name);
std::string text_attribute(hid_t object, const std::string& name);
std::vector<std::string> attribute_names(hid_t object);

/// Names of the links in a group, sorted.
std::vector<std::string> children(hid_t group);

/// What a contiguous dataset looks like and where its bytes lie in the file.
struct Extent {
    ValueType type = ValueType::f64;
    std::uint64_t rows = 0;
    std::size_t components = 1;
    std::uint64_t offset = 0;  ///< of its first byte in the file; 0 if it has none
    std::size_t row_bytes() const { return components * size_of(type); }
};
/// Throws if the dataset is not contiguous, of one or two dimensions, in native byte order.
Extent extent_of(hid_t dataset);

}  // namespace talus::hdf5
