#include "src/water/water_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "src/water/wall_loads.hpp"

namespace talus {

WaterRecord::WaterRecord(const WaterSetup& setup, const std::vector<std::string>& names,
                         std::vector<WaterGauge> gauges)
    : axes_(setup.box.dimension == 2 ? "xy" : "xyz"),
      has_level_(norm(setup.settings.bearing) > 0),
      open_(setup.open),
      gauges_(std::move(gauges)) {
    const auto& boundary = setup.box.boundary;
    if (std::find(boundary.begin(), boundary.end(), Boundary::periodic) == boundary.end())
        turns_ = setup.box.dimension == 2 ? "z" : "xyz";
    for (std::size_t b = 0; b < setup.records_force.size(); ++b)
        if (setup.records_force[b]) recorded_.push_back(names[b]);
}

std::vector<CsvColumn> WaterRecord::columns() const {
    std::vector<CsvColumn> columns;
    const auto add_passed = [&](const char* way, const std::string& name) {
        columns.push_back({fmt::format("{}_particles_{}", way, name), "1"});
        columns.push_back({fmt::format("{}_mass_{}", way, name), "kg"});
    };
    for (std::size_t b = 0; b < open_.buffers.size(); ++b) {
        const bool is_inflow = open_.buffers[b].kind == water::Buffer::Kind::inflow;
        if (!open_.buffers[b].is_open()) continue;
        add_passed(is_inflow ? "inflow" : "outflow", open_.names[b]);
        if (is_inflow) add_passed("returned", open_.names[b]);
    }
    for (const std::string& name : recorded_) {
        for (const char axis : axes_) columns.push_back({fmt::format("force_{}_{}", name, axis), "N"});
        for (const char axis : turns_) columns.push_back({fmt::format("torque_{}_{}", name, axis), "N m"});
    }
    for (const WaterGauge& gauge : gauges_) {
        columns.push_back({"pressure_" + gauge.name, "Pa"});
        for (const char axis : axes_)
            columns.push_back({fmt::format("velocity_{}_{}", gauge.name, axis), "m s-1"});
        if (has_level_) columns.push_back({"level_" + gauge.name, "m"});
    }
    return columns;
}

void WaterRecord::measure(WaterSimulation& simulation, std::vector<double>& row) const {
    const auto component = [](const auto& v, char axis) {
        return axis == 'x' ? v.x : axis == 'y' ? v.y : v.z;
    };
    const auto add_passed = [&](const OpenBoundaries::Passed& passed) {
        row.insert(row.end(), {static_cast<double>(passed.count), passed.mass});
    };
    for (std::size_t b = 0; b < open_.buffers.size(); ++b) {
        if (!open_.buffers[b].is_open()) continue;
        add_passed(simulation.open()->passed(b));
        if (open_.buffers[b].kind == water::Buffer::Kind::inflow) add_passed(simulation.open()->returned(b));
    }
    if (!recorded_.empty())
        for (const WallLoad& load : wall_loads(simulation)) {
            for (const char axis : axes_) row.push_back(component(load.force, axis));
            for (const char axis : turns_) row.push_back(component(load.torque, axis));
        }
    if (gauges_.empty()) return;
    for (const WaterReading& reading : read_gauges(simulation, gauges_)) {
        row.push_back(reading.pressure);
        row.insert(row.end(), reading.velocity.begin(),
                   reading.velocity.begin() + static_cast<std::ptrdiff_t>(axes_.size()));
        if (has_level_) row.push_back(reading.level);
    }
}

}  // namespace talus
