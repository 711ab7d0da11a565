#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/csv.hpp"
#include "src/flow/grain_flow.hpp"
#include "src/flow/region_statistics.hpp"

namespace talus {

// Columns of diagnostics.csv that a scene asks for, and their values.

/// Of grains that come and go; none if a scene has neither sink nor source.
void append_flow_columns(const GrainFlowPlan& plan, std::vector<CsvColumn>& columns);
/// `total` grains are there.
void append_flow_values(const GrainFlow& flow, std::uint64_t total, std::vector<double>& row);

/// Of regions; `bodies` are the names of the bodies of grains.
void append_region_columns(std::span<const WatchedRegion> regions, std::span<const std::string> bodies,
                           std::vector<CsvColumn>& columns);
void append_region_values(std::span<const WatchedRegion> regions, std::span<const RegionState> states,
                          std::vector<double>& row);

}  // namespace talus
