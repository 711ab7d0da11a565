#pragma once
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>

namespace talus::test {

/// One point of the map of stability: a knob on one side of a threshold, and what came of it.
struct StabilityRow {
    std::string_view failure;  ///< what fails
    std::string scene;
    std::string_view knob;
    double value;      ///< of the knob
    double threshold;  ///< of the knob, by theory; infinite: there is none
    std::string_view metric;
    double found;  ///< of the metric
    bool stable;
};

/// A line that tools/chart stability reads.
inline void print(const StabilityRow& row) {
    fmt::print(
        "{{\"failure\": \"{}\", \"scene\": \"{}\", \"knob\": \"{}\", \"value\": {:.6g}, \"threshold\": {}, "
        "\"metric\": \"{}\", \"found\": {:.4g}, \"stable\": {}}}\n",
        row.failure, row.scene, row.knob, row.value,
        std::isfinite(row.threshold) ? fmt::format("{:.6g}", row.threshold) : "null", row.metric, row.found,
        row.stable);
}

}  // namespace talus::test
