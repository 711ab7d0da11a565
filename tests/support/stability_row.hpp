#pragma once
#include <fmt/format.h>

#include <string_view>

namespace talus::test {

/// One point of the map of stability: a knob on one side of a threshold, and what came of it.
struct StabilityRow {
    std::string_view failure;  ///< what fails
    std::string_view scene;
    std::string_view knob;
    double value;      ///< of the knob
    double threshold;  ///< of the knob, by theory
    std::string_view metric;
    double found;  ///< of the metric
    bool stable;
};

/// A line that tools/chart stability reads.
inline void print(const StabilityRow& row) {
    fmt::print(
        "{{\"failure\": \"{}\", \"scene\": \"{}\", \"knob\": \"{}\", \"value\": {:.6g}, \"threshold\": {:.6g}, "
        "\"metric\": \"{}\", \"found\": {:.4g}, \"stable\": {}}}\n",
        row.failure, row.scene, row.knob, row.value, row.threshold, row.metric, row.found, row.stable);
}

}  // namespace talus::test
