#include "src/run/performance_log.hpp"

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

namespace talus {

namespace {

std::vector<CsvColumn> performance_columns() {
    std::vector<CsvColumn> columns = {{"time", "s"},      {"ranks", "1"},
                                      {"imbalance", "1"}, {"imbalance_of_time", "1"},
                                      {"cuts", "1"},      {"copies_of_a_rank", "1"},
                                      {"halo_bytes", "1"}};
    for (const std::string_view phase : phase_names) {
        std::string name(phase);
        std::replace(name.begin(), name.end(), ' ', '_');
        columns.push_back({std::move(name), "s"});
    }
    return columns;
}

/// Time spent on particles and pairs alone, without others.
double computing(std::span<const double> seconds) {
    double sum = 0;
    for (const Phase phase :
         {Phase::density, Phase::gradients, Phase::forces, Phase::gravity, Phase::material, Phase::motion})
        sum += seconds[static_cast<std::size_t>(phase)];
    return sum;
}

/// The largest value of a rank over the mean.
double imbalance_of(std::span<const double> of_ranks) {
    const double total = std::accumulate(of_ranks.begin(), of_ranks.end(), 0.0);
    return total > 0 ? *std::max_element(of_ranks.begin(), of_ranks.end()) *
                           static_cast<double>(of_ranks.size()) / total
                     : 1;
}

}  // namespace

PerformanceLog::PerformanceLog(const Communicator& comm, const std::filesystem::path& folder,
                               std::optional<std::uint64_t> restart_step)
    : comm_(comm), table_(comm, folder / "performance.csv", performance_columns(), restart_step) {}

PerformanceLog::Counters PerformanceLog::counters_of(const Simulation& simulation) {
    return {simulation.step_count(), simulation.phases().seconds(),
            static_cast<double>(simulation.decomposition().halo().bytes_sent())};
}

void PerformanceLog::write(const Simulation& simulation) {
    const Counters now = counters_of(simulation);
    if (now.step == last_.step) return;
    std::vector<double> mine = {simulation.work(), now.halo_bytes - last_.halo_bytes,
                                static_cast<double>(simulation.particles().halo_size())};
    const std::size_t first_phase = mine.size();
    for (std::size_t p = 0; p < now.seconds.size(); ++p) mine.push_back(now.seconds[p] - last_.seconds[p]);
    last_ = now;

    const std::vector<double> all = comm_.all_gather(std::span<const double>(mine));
    const auto ranks = static_cast<std::size_t>(comm_.size());
    const auto of_ranks = [&](auto&& value) {
        std::vector<double> values;
        for (std::size_t r = 0; r < ranks; ++r)
            values.push_back(value(std::span(all).subspan(r * mine.size(), mine.size())));
        return values;
    };
    const auto greatest = [&](std::size_t k) {
        return std::ranges::max(of_ranks([k](std::span<const double> rank) { return rank[k]; }));
    };
    std::vector<double> row = {simulation.time(),
                               static_cast<double>(ranks),
                               imbalance_of(of_ranks([](std::span<const double> rank) { return rank[0]; })),
                               imbalance_of(of_ranks([&](std::span<const double> rank) {
                                   return computing(rank.subspan(first_phase));
                               })),
                               static_cast<double>(simulation.decomposition().rebalance_count()),
                               greatest(2),
                               greatest(1)};
    for (std::size_t k = first_phase; k < mine.size(); ++k) {
        const std::vector<double> seconds = of_ranks([k](std::span<const double> rank) { return rank[k]; });
        row.push_back(std::accumulate(seconds.begin(), seconds.end(), 0.0) / static_cast<double>(ranks));
    }
    table_.write(now.step, row);
}

}  // namespace talus
