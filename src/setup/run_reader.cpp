#include "src/setup/run_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace talus {

Box read_box(const Section& table, int dimension) {
    Box box;
    box.dimension = dimension;
    const auto count = static_cast<std::size_t>(dimension);
    const std::vector<std::string> kinds =
        table.texts("boundaries", count, std::vector<std::string>(count, "open"));
    bool closed = false;
    for (std::size_t a = 0; a < std::min(count, kinds.size()); ++a) {
        if (kinds[a] == "periodic")
            box.boundary[a] = Boundary::periodic;
        else if (kinds[a] == "reflecting")
            box.boundary[a] = Boundary::reflecting;
        else if (kinds[a] != "open")
            table.error(
                "boundaries",
                fmt::format("'{}' is not a boundary (allowed: open, periodic, reflecting)", kinds[a]));
        closed |= box.boundary[a] != Boundary::open;
    }
    if (!closed && !table.has("lower") && !table.has("upper")) return box;
    const std::vector<double> lower = table.numbers("lower", "m", count),
                              upper = table.numbers("upper", "m", count);
    for (std::size_t a = 0; a < count && a < lower.size() && a < upper.size(); ++a) {
        box.lower[a] = lower[a];
        box.upper[a] = upper[a];
        if (!(lower[a] < upper[a])) {
            table.error("upper", fmt::format("must be above lower along {}", "xyz"[a]));
            box.upper[a] = lower[a] + 1;
        }
    }
    return box;
}

void read_references(const Section& root) {
    for (const Section& reference : root.sections("reference")) {
        reference.text("name");
        const std::string file = reference.text("file", "diagnostics.csv");
        if (const std::filesystem::path path = file;
            path.has_parent_path() || (path.extension() != ".csv" && path.extension() != ".json"))
            reference.error("file",
                            fmt::format("'{}' is not the name of a .csv or .json file of the output", file));
        reference.text("figure");
        reference.number("value", "");
        reference.number("uncertainty", "", 0.0, {0});
        if (reference.has("time")) reference.number("time", "s");
        reference.text("source");
    }
}

OutputPlan read_output(const Section& root) {
    constexpr Range not_negative{0};
    const Section run = root.section("run"), output = root.section("output");
    OutputPlan plan;
    plan.end_time = run.number("end_time", "s", {}, {0, std::numeric_limits<double>::infinity(), true});
    plan.snapshot_interval = output.number("snapshots", "s", 0.0, not_negative);
    plan.diagnostics_interval = output.number("diagnostics", "s", 0.0, not_negative);
    plan.checkpoint_interval = output.number("checkpoints", "s", 1800.0, not_negative);
    read_references(root);
    return plan;
}

PartitionMethod read_partition(const Section& table) {
    const std::string name =
        table.choice("decomposition", {"cheapest", "metis", "bisection", "slabs", "scrambled"}, "cheapest");
    if (name == "metis") return PartitionMethod::metis;
    if (name == "bisection") return PartitionMethod::bisection;
    if (name == "slabs") return PartitionMethod::slabs;
    if (name == "scrambled") return PartitionMethod::scrambled;
    return PartitionMethod::cheapest;
}

int read_rebalance_interval(const Section& run) {
    return static_cast<int>(run.integer("rebalance_interval", 10, 0, 1000000));
}

}  // namespace talus
