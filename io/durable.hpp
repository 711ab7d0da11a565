#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

/// Files that are there when we say so. All functions are for one rank and throw std::runtime_error
/// "file: what failed (why)".
namespace talus {

/// Makes sure that `bytes` more fit on the file system of `directory`.
void check_space(const std::filesystem::path& directory, std::uint64_t bytes);

/// Reserves the disk blocks of a file as long as it is now, so that no later write to it can fail for want of
/// space.
void reserve_space(const std::filesystem::path& file);

/// Waits until the file's content is on disk.
void sync_file(const std::filesystem::path& file);

/// Gives a synced file its final name, replacing what had it, and waits until the name is on disk.
void publish(const std::filesystem::path& temporary, const std::filesystem::path& file);

/// Replaces a small file by `text`: either the old or the new content is there at any time.
void replace_file(const std::filesystem::path& file, std::string_view text);

/// Where a file is written before it is published.
std::filesystem::path temporary_name(const std::filesystem::path& file);

/// A file opened for reading at given offsets.
class FileReader {
  public:
    explicit FileReader(const std::filesystem::path& file);
    ~FileReader();
    FileReader(const FileReader&) = delete;
    FileReader& operator=(const FileReader&) = delete;
    /// Fills `bytes` from `offset` on; a file that ends before is an error.
    void read(std::uint64_t offset, std::span<std::byte> bytes) const;
    std::uint64_t size() const;

  private:
    std::filesystem::path file_;
    int descriptor_;
};

/// A file that is there, opened for writing at given offsets.
class FileWriter {
  public:
    explicit FileWriter(const std::filesystem::path& file);
    ~FileWriter();
    FileWriter(const FileWriter&) = delete;
    FileWriter& operator=(const FileWriter&) = delete;
    void write(std::uint64_t offset, std::span<const std::byte> bytes) const;

  private:
    std::filesystem::path file_;
    int descriptor_;
};

}  // namespace talus
