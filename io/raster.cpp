#include "io/raster.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "io/agree.hpp"
#include "io/ascii_grid.hpp"
#include "io/durable.hpp"
#include "io/geodata/module.hpp"

namespace talus {

namespace {

/// Loads GDAL and what of ours calls it, once.
const GeodataModule& geodata() {
    static const GeodataModule* const module = [] {
        void* const library = ::dlopen("talus_geodata.so", RTLD_NOW | RTLD_LOCAL);
        const void* const found = library ? ::dlsym(library, "talus_geodata_module") : nullptr;
        if (!found)
            throw std::runtime_error(fmt::format("needs GDAL, which cannot be loaded ({})", ::dlerror()));
        return static_cast<const GeodataModule*>(found);
    }();
    return *module;
}

std::string read_bytes(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw std::runtime_error("cannot be opened");
    std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    if (stream.bad()) throw std::runtime_error("cannot be read");
    return bytes;
}

std::filesystem::path reference_file(std::filesystem::path file) { return file.replace_extension(".prj"); }

bool is_tiff_name(const std::filesystem::path& file) {
    return file.extension() == ".tif" || file.extension() == ".tiff";
}

Raster read_here(const std::filesystem::path& file) {
    char magic[4] = {};
    std::ifstream(file, std::ios::binary).read(magic, sizeof magic);
    const std::string_view start(magic, 2);
    Raster raster;
    if ((start == "II" || start == "MM") &&
        (magic[2] == 42 || magic[3] == 42 || magic[2] == 43 || magic[3] == 43)) {
        raster = geodata().read_geotiff(file.string());
    } else {
        raster.grid = parse_ascii_grid(read_bytes(file));
        if (const auto beside = reference_file(file); std::filesystem::exists(beside))
            raster.reference = read_bytes(beside);
    }
    if (!raster.reference.empty())
        if (const std::string why = geodata().why_not_metres(raster.reference); !why.empty())
            throw std::runtime_error(why);
    return raster;
}

/// Runs `action` on the root; messages get the file's name in front. Collective.
template <class Action>
void on_root(const Communicator& comm, const std::filesystem::path& file, const Action& action) {
    agree_on_root(comm, [&] {
        try {
            action();
        } catch (const std::exception& error) {
            throw std::runtime_error(fmt::format("{}: {}", file.string(), error.what()));
        }
    });
}

/// Values one after another as bytes, and back.
class Packing {
  public:
    explicit Packing(std::string bytes = "") : bytes_(std::move(bytes)) {}
    const std::string& bytes() const { return bytes_; }

    template <class T>
    void put(const T* values, std::size_t count) {
        bytes_.append(reinterpret_cast<const char*>(values), count * sizeof(T));
    }
    void put_text(const std::string& text) {
        put_count(text.size());
        put(text.data(), text.size());
    }
    void put_count(std::uint64_t count) { put(&count, 1); }

    template <class T>
    void get(T* values, std::size_t count) {
        std::memcpy(values, bytes_.data() + at_, count * sizeof(T));
        at_ += count * sizeof(T);
    }
    std::string get_text() {
        std::string text(get_count(), ' ');
        get(text.data(), text.size());
        return text;
    }
    std::uint64_t get_count() {
        std::uint64_t count = 0;
        get(&count, 1);
        return count;
    }

  private:
    std::string bytes_;
    std::size_t at_ = 0;
};

}  // namespace

Raster read_raster(const Communicator& comm, const std::filesystem::path& file) {
    Packing packing;
    on_root(comm, file, [&] {
        const Raster raster = read_here(file);
        packing.put(&raster.grid.origin, 1);
        packing.put(&raster.grid.spacing, 1);
        packing.put_count(raster.grid.columns);
        packing.put_count(raster.grid.rows);
        packing.put(raster.grid.elevations.data(), raster.grid.elevations.size());
        packing.put_text(raster.reference);
        constexpr std::size_t most = std::size_t{1} << 31;
        if (packing.bytes().size() >= most) throw std::runtime_error("is larger than 2 GiB of values");
    });
    packing = Packing(comm.all_broadcast(packing.bytes()));
    Raster raster;
    packing.get(&raster.grid.origin, 1);
    packing.get(&raster.grid.spacing, 1);
    raster.grid.columns = packing.get_count();
    raster.grid.rows = packing.get_count();
    raster.grid.elevations.resize(raster.grid.columns * raster.grid.rows);
    packing.get(raster.grid.elevations.data(), raster.grid.elevations.size());
    raster.reference = packing.get_text();
    return raster;
}

void write_raster(const Communicator& comm, const std::filesystem::path& file, const Raster& raster) {
    on_root(comm, file, [&] {
        if (is_tiff_name(file)) {
            replace_file(file, geodata().geotiff(raster));
            return;
        }
        replace_file(file, ascii_grid(raster.grid));
        if (!raster.reference.empty()) replace_file(reference_file(file), raster.reference);
    });
}

Areas read_areas(const Communicator& comm, const std::filesystem::path& file) {
    Packing packing;
    on_root(comm, file, [&] {
        const Areas areas = geodata().read_areas(file.string());
        packing.put_text(areas.reference);
        packing.put_count(areas.polygons.size());
        for (const Polygon& polygon : areas.polygons) {
            packing.put_count(polygon.rings.size());
            for (const Polygon::Ring& ring : polygon.rings) {
                packing.put_count(ring.size());
                packing.put(ring.data(), ring.size());
            }
            packing.put_count(polygon.numbers.size());
            for (const auto& [name, value] : polygon.numbers) {
                packing.put_text(name);
                packing.put(&value, 1);
            }
            packing.put_count(polygon.texts.size());
            for (const auto& [name, text] : polygon.texts) {
                packing.put_text(name);
                packing.put_text(text);
            }
        }
    });
    packing = Packing(comm.all_broadcast(packing.bytes()));
    Areas areas;
    areas.reference = packing.get_text();
    areas.polygons.resize(packing.get_count());
    for (Polygon& polygon : areas.polygons) {
        polygon.rings.resize(packing.get_count());
        for (Polygon::Ring& ring : polygon.rings) {
            ring.resize(packing.get_count());
            packing.get(ring.data(), ring.size());
        }
        for (std::uint64_t left = packing.get_count(); left > 0; --left) {
            double& value = polygon.numbers[packing.get_text()];
            packing.get(&value, 1);
        }
        for (std::uint64_t left = packing.get_count(); left > 0; --left) {
            std::string& text = polygon.texts[packing.get_text()];
            text = packing.get_text();
        }
    }
    return areas;
}

bool is_same_reference(const Communicator& comm, const std::string& one, const std::string& other) {
    if (one.empty() || other.empty() || one == other) return true;
    bool is_same = false;
    agree_on_root(comm, [&] { is_same = geodata().is_same_reference(one, other); });
    return comm.all_broadcast(is_same ? "same" : "") == "same";
}

}  // namespace talus
