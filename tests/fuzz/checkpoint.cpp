#include "io/checkpoint.hpp"

#include <mpi.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include "io/file_guard.hpp"
#include "io/hashing.hpp"
#include "io/hdf5_file.hpp"
#include "tests/fuzz/alone.hpp"
#include "tests/mpi/random_particles.hpp"

/// A checkpoint is changed by a list of edits and, as long as they leave it an HDF5 file, sealed again: what
/// is then read is refused, or it is the particles that were written.

namespace talus::test {
namespace {

using hdf5::Handle;

/// The bytes of an input, one by one; zeros after the last.
class Choices {
  public:
    Choices(const std::uint8_t* data, std::size_t size) : left_(data, size) {}
    bool any() const { return !left_.empty(); }
    std::size_t below(std::size_t count) {
        if (count == 0) return 0;
        std::size_t value = 0;
        for (std::size_t most = count - 1; most > 0; most >>= 8) value = value << 8 | byte();
        return value % count;
    }

  private:
    std::size_t byte() {
        if (left_.empty()) return 0;
        const std::size_t first = left_.front();
        left_ = left_.subspan(1);
        return first;
    }
    std::span<const std::uint8_t> left_;
};

/// What all inputs begin with: a checkpoint, without its index.
struct Sample {
    testing::SharedFolder folder;
    std::filesystem::path file;
    std::string bytes, hash;
    explicit Sample(const Communicator& alone) : folder(alone) {
        const ParticleSet set = testing::random_set(alone, 50, 1);
        const RunState state = testing::some_state(1);
        write_checkpoint(alone, folder.path, state, {&set});
        file = folder.path / "checkpoint_000000001.h5";
        std::ifstream stream(file, std::ios::binary);
        bytes.assign(std::istreambuf_iterator<char>(stream), {});
        std::fill_n(bytes.begin(), guard_size(state_columns(set).size()), '\0');
        hash = state_hash(alone, {}, {&set});
    }
};

/// Paths of all groups and datasets.
std::vector<std::string> objects(hid_t file) {
    std::vector<std::string> found;
    const auto note = [](hid_t, const char* name, const H5O_info_t*, void* list) -> herr_t {
        static_cast<std::vector<std::string>*>(list)->push_back(name);
        return 0;
    };
    H5Ovisit(file, H5_INDEX_NAME, H5_ITER_INC, note, &found);
    return found;
}

std::vector<DataRegion> data_regions(hid_t file) {
    std::vector<DataRegion> found;
    for (const std::string& path : objects(file)) {
        const Handle object(H5Oopen(file, path.c_str(), H5P_DEFAULT), H5Oclose, "open");
        if (H5Iget_type(object) != H5I_DATASET) continue;
        try {
            const hdf5::Extent extent = hdf5::extent_of(object);
            if (extent.rows > 0 && extent.offset > 0)
                found.push_back({"/" + path, extent.offset, extent.rows * extent.row_bytes()});
        } catch (const std::exception&) {  // a text: one of the metadata
        }
    }
    return found;
}

void edit_attribute(hid_t file, const std::string& path, Choices& choices) {
    const Handle object(H5Oopen(file, path.c_str(), H5P_DEFAULT), H5Oclose, "open");
    const std::vector<std::string> names = hdf5::attribute_names(object);
    if (names.empty()) return;
    const std::string& name = names[choices.below(names.size())];
    H5Adelete(object, name.c_str());
    constexpr std::array<std::uint64_t, 6> values{0, 1, 2, 51, 1u << 31, ~std::uint64_t{0}};
    switch (choices.below(5)) {
        case 0:
            return;
        case 1:
            return hdf5::set_attribute(object, name, values[choices.below(values.size())]);
        case 2:
            return hdf5::set_attribute(object, name, std::string(choices.below(9), 'x'));
        case 3:
            return hdf5::set_attribute(object, name, std::array{0.5, -1.0});
        default:
            return hdf5::set_attribute(object, name, static_cast<double>(choices.below(3)) - 1);
    }
}

/// One change of what the file holds.
void edit(hid_t file, Choices& choices) {
    const std::vector<std::string> paths = objects(file);
    const std::string path = paths[choices.below(paths.size())];
    if (path == ".") return;
    switch (choices.below(5)) {
        case 0:
            H5Ldelete(file, path.c_str(), H5P_DEFAULT);
            break;
        case 1:
            H5Lmove(file, path.c_str(), file, (path + "x").c_str(), H5P_DEFAULT, H5P_DEFAULT);
            break;
        case 2: {
            constexpr std::array types{ValueType::f64, ValueType::f32, ValueType::u64, ValueType::u8};
            H5Ldelete(file, path.c_str(), H5P_DEFAULT);
            hdf5::create_dataset(file, path, types[choices.below(types.size())], choices.below(60),
                                 choices.below(4));
            break;
        }
        case 3:
            hdf5::create_group(file, path + "y");
            break;
        default:
            edit_attribute(file, path, choices);
    }
}

/// Up to twenty edits, some of the bytes themselves.
void spoil(const Sample& sample, Choices& choices) {
    std::ofstream(sample.file, std::ios::binary) << sample.bytes;
    bool sealed = false;
    for (int k = 0; k < 20 && choices.any(); ++k) {
        const std::size_t kind = choices.below(sealed ? 2 : 8);
        if (kind >= 2) {
            Handle file = hdf5::open_file(sample.file, true);
            try {
                edit(file, choices);
            } catch (const std::runtime_error&) {  // HDF5 refuses it: another edit
            }
            continue;
        }
        if (!sealed) {
            std::vector<DataRegion> regions = data_regions(hdf5::open_file(sample.file, false));
            write_guard(sample.file, regions);
            sealed = true;
        }
        const std::size_t size = std::filesystem::file_size(sample.file), at = choices.below(size);
        if (kind == 0) {
            std::filesystem::resize_file(sample.file, at);
        } else {
            std::fstream stream(sample.file, std::ios::binary | std::ios::in | std::ios::out);
            stream.seekp(static_cast<std::streamoff>(at));
            stream.put(static_cast<char>(choices.below(256)));
        }
    }
    if (!sealed) {
        std::vector<DataRegion> regions = data_regions(hdf5::open_file(sample.file, false));
        write_guard(sample.file, regions);
    }
}

}  // namespace
}  // namespace talus::test

extern "C" int LLVMFuzzerInitialize(int* count, char*** values) {
    const int code = talus::test::start_alone(count, values);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    return code;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace talus;
    static const Communicator alone(MPI_COMM_SELF);
    static const test::Sample sample(alone);
    test::Choices choices(data, size);
    test::spoil(sample, choices);
    ParticleSet set("rock", 3);
    testing::add_fields(set);
    try {
        read_checkpoint(alone, sample.file, {&set});
    } catch (const AgreedError&) {
        return 0;
    }
    if (state_hash(alone, {}, {&set}) != sample.hash) std::abort();
    return 0;
}
