#pragma once
#include <cstdint>
#include <vector>

#include "io/csv.hpp"
#include "src/flow/grain_flow.hpp"

namespace talus {

// Columns of diagnostics.csv about grains that come and go; none if a scene has neither sink nor source.

void append_flow_columns(const GrainFlowPlan& plan, std::vector<CsvColumn>& columns);
/// Their values; `total` grains are there.
void append_flow_values(const GrainFlow& flow, std::uint64_t total, std::vector<double>& row);

}  // namespace talus
