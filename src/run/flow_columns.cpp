#include "src/run/flow_columns.hpp"

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

}  // namespace talus
