#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "comm/communicator.hpp"

namespace talus {

/// A column of numbers with its UDUNITS unit, "1" or empty if it has none.
struct CsvColumn {
    std::string name;
    std::string unit;
};

/// A table that grows by a row a record: the step, then numbers in the shortest form that reads back to the
/// same bits. Only the root writes. Failures are AgreedErrors (exit code 3) on every rank.
class CsvWriter {
  public:
    /// Begins the file anew, or, after a restart from `restart_step`, keeps its rows up to that step; the
    /// columns must then be the same. The first column, step, is not among `columns`. Collective.
    CsvWriter(const Communicator& comm, const std::filesystem::path& file, std::vector<CsvColumn> columns,
              std::optional<std::uint64_t> restart_step = {});
    ~CsvWriter();
    CsvWriter(const CsvWriter&) = delete;
    CsvWriter& operator=(const CsvWriter&) = delete;

    /// Adds a row; values of the root count. A row that does not fit on the disk is taken back. Collective.
    void write(std::uint64_t step, std::span<const double> values);

  private:
    void append(const std::string& row) const;

    const Communicator& comm_;
    std::filesystem::path file_;
    std::size_t columns_;
    int descriptor_ = -1;
};

}  // namespace talus
