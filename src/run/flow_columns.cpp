#include "src/run/flow_columns.hpp"

#include <fmt/format.h>

namespace talus {

void append_flow_columns(const GrainFlowPlan& plan, std::vector<CsvColumn>& columns) {
    if (plan.empty()) return;
    columns.push_back({"grains", "1"});
    for (const GrainSource& source : plan.sources) {
        columns.push_back({"inserted_" + source.name, "1"});
        columns.push_back({"inserted_mass_" + source.name, "kg"});
        columns.push_back({"missed_" + source.name, "1"});
    }
    for (const GrainSink& sink : plan.sinks) {
        columns.push_back({"deleted_" + sink.name, "1"});
        columns.push_back({"deleted_mass_" + sink.name, "kg"});
    }
}

void append_flow_values(const GrainFlow& flow, std::uint64_t total, std::vector<double>& row) {
    if (flow.plan().empty()) return;
    row.push_back(static_cast<double>(total));
    for (const GrainFlow::Came& came : flow.came()) {
        row.push_back(static_cast<double>(came.count));
        row.push_back(came.mass);
        row.push_back(static_cast<double>(came.missed));
    }
    for (const GrainFlow::Passed& passed : flow.passed()) {
        row.push_back(static_cast<double>(passed.count));
        row.push_back(passed.mass);
    }
}

void append_region_columns(std::span<const WatchedRegion> regions, std::span<const std::string> bodies,
                           std::vector<CsvColumn>& columns) {
    for (const WatchedRegion& region : regions) {
        columns.push_back({"grains_" + region.name, "1"});
        if (bodies.size() > 1)
            for (const std::string& body : bodies)
                columns.push_back({fmt::format("grains_{}_{}", region.name, body), "1"});
        columns.push_back({"mass_" + region.name, "kg"});
        columns.push_back({"solid_fraction_" + region.name, "1"});
        for (const char axis : {'x', 'y', 'z'})
            columns.push_back({fmt::format("velocity_{}_{}", region.name, axis), "m s-1"});
        if (region.stress)
            for (const char* axes : {"xx", "yy", "zz", "xy", "yz", "xz"})
                columns.push_back({fmt::format("stress_{}_{}", region.name, axes), "Pa"});
    }
}

void append_region_values(std::span<const WatchedRegion> regions, std::span<const RegionState> states,
                          std::vector<double>& row) {
    for (std::size_t k = 0; k < regions.size(); ++k) {
        const RegionState& state = states[k];
        row.push_back(static_cast<double>(state.count));
        if (state.of_body.size() > 1) row.insert(row.end(), state.of_body.begin(), state.of_body.end());
        row.push_back(state.mass);
        row.push_back(state.solid_fraction);
        row.insert(row.end(), state.velocity.begin(), state.velocity.end());
        if (regions[k].stress) row.insert(row.end(), state.stress.begin(), state.stress.end());
    }
}

}  // namespace talus
