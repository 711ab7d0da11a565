#include "io/csv.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "io/agree.hpp"
#include "io/durable.hpp"

namespace talus {
namespace {

std::string header_of(const std::vector<CsvColumn>& columns) {
    std::string line("step");
    for (const CsvColumn& column : columns) {
        line += fmt::format(",{}", column.name);
        if (!column.unit.empty() && column.unit != "1") line += fmt::format(" [{}]", column.unit);
    }
    return line;
}

/// The rows of an earlier run up to a step; a row that was cut off when the run was killed is dropped.
std::string kept_rows(const std::filesystem::path& file, const std::string& header,
                      std::uint64_t restart_step) {
    std::string kept = header;
    kept += '\n';
    std::ifstream stream(file);
    std::string line;
    if (!std::getline(stream, line)) return kept;
    if (line != header)
        throw std::runtime_error(fmt::format("{}: its columns are '{}', this run's are '{}'; move it away",
                                             file.string(), line, header));
    const auto commas = std::count(header.begin(), header.end(), ',');
    while (std::getline(stream, line)) {
        std::uint64_t step = 0;
        const bool is_row = std::from_chars(line.data(), line.data() + line.size(), step).ec == std::errc() &&
                            std::count(line.begin(), line.end(), ',') == commas && !stream.eof();
        if (!is_row || step > restart_step) continue;
        kept += line;
        kept += '\n';
    }
    return kept;
}

}  // namespace

CsvWriter::CsvWriter(const Communicator& comm, const std::filesystem::path& file,
                     std::vector<CsvColumn> columns, std::optional<std::uint64_t> restart_step)
    : comm_(comm), file_(file), columns_(columns.size()) {
    agree_on_root(comm, [&] {
        if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path());
        const std::string header = header_of(columns);
        replace_file(file,
                     restart_step ? kept_rows(file, header, *restart_step) : fmt::format("{}\n", header));
        descriptor_ = ::open(file.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
        if (descriptor_ < 0)
            throw std::runtime_error(
                fmt::format("{}: cannot be opened ({})", file.string(), std::strerror(errno)));
    });
}

CsvWriter::~CsvWriter() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

void CsvWriter::write(std::uint64_t step, std::span<const double> values) {
    agree_on_root(comm_, [&] {
        if (values.size() != columns_)
            throw std::logic_error("a row has not as many values as the table has columns");
        std::string row = fmt::format("{}", step);
        for (const double value : values) row += fmt::format(",{}", value);
        row += '\n';
        append(row);
    });
}

void CsvWriter::append(const std::string& row) const {
    const off_t before = ::lseek(descriptor_, 0, SEEK_END);
    const ssize_t written = ::write(descriptor_, row.data(), row.size());
    if (written == static_cast<ssize_t>(row.size())) return;
    const int reason = written < 0 ? errno : ENOSPC;
    // Half a row would be read as a wrong one.
    const bool taken_back = before >= 0 && ::ftruncate(descriptor_, before) == 0;
    throw std::runtime_error(fmt::format("{}: cannot be written ({}){}", file_.string(),
                                         std::strerror(reason),
                                         taken_back ? "" : "; its last row is incomplete"));
}

}  // namespace talus
