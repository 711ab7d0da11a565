#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "io/csv.hpp"
#include "src/simulation.hpp"

namespace talus {

/// `performance.csv`: how evenly the work is spread and where time goes, a row for each time that has passed
/// since the last one. Nothing is exchanged but for a row.
class PerformanceLog {
  public:
    /// `restart_step`: see CsvWriter. Collective.
    PerformanceLog(const Communicator& comm, const std::filesystem::path& folder,
                   std::optional<std::uint64_t> restart_step);

    /// Counts from here on, without a row.
    void begin(const Simulation& simulation) { last_ = counters_of(simulation); }
    /// Adds a row for the steps since the last call, if there were any. Collective.
    void write(const Simulation& simulation);

  private:
    struct Counters {
        std::uint64_t step = 0;
        std::array<double, phase_names.size()> seconds{};
        double halo_bytes = 0;
    };
    static Counters counters_of(const Simulation& simulation);

    const Communicator& comm_;
    CsvWriter table_;
    Counters last_;
};

}  // namespace talus
