#include "io/durable.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace talus {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, std::string_view what, int reason = errno) {
    throw std::runtime_error(fmt::format("{}: {} ({})", file.string(), what, std::strerror(reason)));
}

struct Descriptor {
    Descriptor(const std::filesystem::path& file, int flags)
        : value(::open(file.c_str(), flags | O_CLOEXEC, 0666)) {
        if (value < 0) fail(file, "cannot be opened");
    }
    ~Descriptor() {
        if (value >= 0) ::close(value);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int value;
};

std::string in_megabytes(std::uint64_t bytes) {
    return fmt::format("{:.1f} MB", static_cast<double>(bytes) * 1e-6);
}

std::uint64_t free_space(const std::filesystem::path& directory) {
    struct statvfs info {};
    if (::statvfs(directory.c_str(), &info) != 0) fail(directory, "cannot be examined");
    return static_cast<std::uint64_t>(info.f_bavail) * info.f_frsize;
}

std::filesystem::path directory_of(const std::filesystem::path& file) {
    return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

}  // namespace

void check_space(const std::filesystem::path& directory, std::uint64_t bytes) {
    const std::uint64_t available = free_space(directory);
    if (available < bytes)
        throw std::runtime_error(fmt::format("{}: no space: needs {}, has {}", directory.string(),
                                             in_megabytes(bytes), in_megabytes(available)));
}

void reserve_space(const std::filesystem::path& file) {
    const Descriptor descriptor(file, O_RDWR);
    const auto size = static_cast<std::uint64_t>(::lseek(descriptor.value, 0, SEEK_END));
    if (size == 0) return;
    const int failure = ::posix_fallocate(descriptor.value, 0, static_cast<off_t>(size));
    if (failure == ENOSPC || failure == EDQUOT || failure == EFBIG)
        throw std::runtime_error(fmt::format("{}: no space: needs {}, has {} ({})", file.string(),
                                             in_megabytes(size), in_megabytes(free_space(directory_of(file))),
                                             std::strerror(failure)));
    if (failure != 0 && failure != EOPNOTSUPP && failure != EINVAL)
        fail(file, "cannot reserve space", failure);
}

void sync_file(const std::filesystem::path& file) {
    const Descriptor descriptor(file, O_RDONLY);
    if (::fsync(descriptor.value) != 0) fail(file, "cannot be synced to disk");
}

void publish(const std::filesystem::path& temporary, const std::filesystem::path& file) {
    if (::rename(temporary.c_str(), file.c_str()) != 0)
        fail(temporary, fmt::format("cannot be renamed to {}", file.string()));
    const Descriptor descriptor(directory_of(file), O_RDONLY | O_DIRECTORY);
    // Some network file systems cannot sync directories and say so by EINVAL.
    if (::fsync(descriptor.value) != 0 && errno != EINVAL)
        fail(directory_of(file), "cannot be synced to disk");
}

void replace_file(const std::filesystem::path& file, std::string_view text) {
    const std::filesystem::path temporary = temporary_name(file);
    {
        const Descriptor descriptor(temporary, O_WRONLY | O_CREAT | O_TRUNC);
        while (!text.empty()) {
            const ssize_t written = ::write(descriptor.value, text.data(), text.size());
            if (written < 0 && errno == EINTR) continue;
            if (written <= 0) {
                const int reason = written < 0 ? errno : ENOSPC;
                ::unlink(temporary.c_str());
                fail(file, "cannot be written", reason);
            }
            text.remove_prefix(static_cast<std::size_t>(written));
        }
        if (::fsync(descriptor.value) != 0) fail(file, "cannot be synced to disk");
    }
    publish(temporary, file);
}

std::filesystem::path temporary_name(const std::filesystem::path& file) { return file.string() + ".tmp"; }

FileReader::FileReader(const std::filesystem::path& file)
    : file_(file), descriptor_(::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (descriptor_ < 0) fail(file, "cannot be opened");
}

FileReader::~FileReader() { ::close(descriptor_); }

void FileReader::read(std::uint64_t offset, std::span<std::byte> bytes) const {
    constexpr std::size_t largest = std::size_t{1} << 30;  // one read() moves at most 2 GiB
    while (!bytes.empty()) {
        const ssize_t count =
            ::pread(descriptor_, bytes.data(), std::min(bytes.size(), largest), static_cast<off_t>(offset));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail(file_, "cannot be read");
        if (count == 0)
            throw std::runtime_error(fmt::format("{}: cut short at byte {}", file_.string(), offset));
        offset += static_cast<std::uint64_t>(count);
        bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
}

std::uint64_t FileReader::size() const {
    struct stat info {};
    if (::fstat(descriptor_, &info) != 0) fail(file_, "cannot be examined");
    return static_cast<std::uint64_t>(info.st_size);
}

FileWriter::FileWriter(const std::filesystem::path& file)
    : file_(file), descriptor_(::open(file.c_str(), O_WRONLY | O_CLOEXEC)) {
    if (descriptor_ < 0) fail(file, "cannot be opened");
}

FileWriter::~FileWriter() { ::close(descriptor_); }

void FileWriter::write(std::uint64_t offset, std::span<const std::byte> bytes) const {
    constexpr std::size_t largest = std::size_t{1} << 30;  // one write() moves at most 2 GiB
    while (!bytes.empty()) {
        const ssize_t count =
            ::pwrite(descriptor_, bytes.data(), std::min(bytes.size(), largest), static_cast<off_t>(offset));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) fail(file_, "cannot be written", count < 0 ? errno : ENOSPC);
        offset += static_cast<std::uint64_t>(count);
        bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
}

}  // namespace talus
