#include "io/file_guard.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <sstream>
#include <stdexcept>

#include "io/durable.hpp"
#include "io/hashing.hpp"

namespace talus {
namespace {

constexpr std::string_view first_line = "Talus checkpoint: this index, then HDF5.\n";
constexpr std::uint64_t largest_guard = std::uint64_t{1} << 24;

/// Checksum of all bytes from `begin` to `end` outside the regions, which must be in order of offset.
std::uint64_t hash_outside(const FileReader& reader, std::uint64_t begin, std::uint64_t end,
                           const std::vector<DataRegion>& regions) {
    std::vector<std::uint64_t> hashes;
    std::vector<std::byte> bytes;
    const auto add = [&](std::uint64_t from, std::uint64_t to) {
        constexpr std::uint64_t piece = std::uint64_t{1} << 24;
        for (; from < to; from += bytes.size()) {
            bytes.resize(std::min(piece, to - from));
            reader.read(from, bytes);
            hashes.push_back(hash64(bytes));
        }
    };
    for (const DataRegion& region : regions) {
        add(begin, region.offset);
        begin = std::max(begin, region.offset + region.bytes);
    }
    add(begin, end);
    return hash64(std::as_bytes(std::span(hashes)));
}

void overwrite_start(const std::filesystem::path& file, const std::string& text) {
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
    const ssize_t written = descriptor < 0 ? -1 : ::pwrite(descriptor, text.data(), text.size(), 0);
    const int reason = errno;
    const int closed = descriptor < 0 ? -1 : ::close(descriptor);
    if (written != static_cast<ssize_t>(text.size()) || closed != 0)
        throw std::runtime_error(
            fmt::format("{}: index cannot be written ({})", file.string(), std::strerror(reason)));
}

struct Index {
    std::uint64_t guard = 0, bytes = 0, metadata_hash = 0;
    std::vector<DataRegion> regions;
};

std::string written(const Index& index) {
    std::string text(first_line);
    text += fmt::format("index {} file {} metadata {:016x}\n", index.guard, index.bytes, index.metadata_hash);
    for (const DataRegion& region : index.regions)
        text += fmt::format("data {} {} {}\n", region.offset, region.bytes, region.name);
    return text + fmt::format("end {:016x}\n", hash64(text));
}

/// Reads the index back; it must be what `written` makes of it, followed by zeros.
Index read_index(const FileReader& reader) {
    const std::uint64_t size = reader.size();
    std::string start(std::min(size, largest_guard), '\0');
    reader.read(0, std::as_writable_bytes(std::span(start)));
    if (!start.starts_with(first_line))
        throw std::runtime_error(size < first_line.size()
                                     ? fmt::format("index: cut short, {} bytes are there", size)
                                     : "index: damaged, or not a checkpoint of Talus");
    std::istringstream stream(start.substr(first_line.size()));
    Index index;
    std::string word, other, third;
    stream >> word >> index.guard >> other >> index.bytes >> third >> std::hex >> index.metadata_hash >>
        std::dec;
    while (stream >> word && word == "data") {
        DataRegion region;
        stream >> region.offset >> region.bytes >> region.name;
        index.regions.push_back(std::move(region));
    }
    const std::string expected = written(index);
    const std::size_t guard = std::min<std::uint64_t>(index.guard, start.size());
    if (!start.starts_with(expected) || guard < expected.size())
        throw std::runtime_error(size < index.guard
                                     ? fmt::format("index: cut short, {} bytes are there", size)
                                     : "index: damaged");
    if (start.find_first_not_of('\0', expected.size()) < guard) throw std::runtime_error("index: damaged");
    return index;
}

}  // namespace

std::uint64_t guard_size(std::size_t regions) {
    std::uint64_t size = 4096;  // HDF5 wants no less than the alignment of create_file()
    while (size < 256 + 256 * regions) size *= 2;
    return size;
}

void write_guard(const std::filesystem::path& file, const std::vector<DataRegion>& regions) {
    const FileReader reader(file);
    Index index;
    index.guard = guard_size(regions.size());
    index.bytes = reader.size();
    index.regions = regions;
    std::sort(index.regions.begin(), index.regions.end(),
              [](const DataRegion& a, const DataRegion& b) { return a.offset < b.offset; });
    index.metadata_hash = hash_outside(reader, index.guard, index.bytes, index.regions);
    const std::string text = written(index);
    if (text.size() > index.guard) throw std::logic_error("names of particle sets and fields are too long");
    overwrite_start(file, text);
}

bool is_guarded(const std::filesystem::path& file) {
    const FileReader reader(file);
    std::string start(std::min<std::uint64_t>(reader.size(), first_line.size()), '\0');
    reader.read(0, std::as_writable_bytes(std::span(start)));
    return start == first_line;
}

void check_guard(const std::filesystem::path& file) {
    const FileReader reader(file);
    const Index index = read_index(reader);
    const std::uint64_t size = reader.size();
    if (size < index.bytes) {
        const auto cut =
            std::find_if(index.regions.begin(), index.regions.end(),
                         [&](const DataRegion& region) { return region.offset + region.bytes > size; });
        throw std::runtime_error(fmt::format("{}: cut short, {} of the file's {} bytes are there",
                                             cut == index.regions.end() ? "end of file" : cut->name, size,
                                             index.bytes));
    }
    if (size > index.bytes)
        throw std::runtime_error(fmt::format("end of file: {} bytes too many", size - index.bytes));
    if (hash_outside(reader, index.guard, index.bytes, index.regions) != index.metadata_hash)
        throw std::runtime_error("metadata: damaged, checksum does not match");
}

}  // namespace talus
