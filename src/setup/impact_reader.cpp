#include "src/setup/impact_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

namespace talus {

namespace {

constexpr Range positive{0, std::numeric_limits<double>::infinity(), true};
constexpr Range not_negative{0};

/// Index of the body that a key names; by default the one at `index`.
std::size_t read_participant(const Section& table, std::string_view key,
                             const std::vector<std::string>& names, std::size_t index) {
    const std::string name = table.text(key, names[index]);
    if (std::count(names.begin(), names.end(), name) != 1) {
        std::string known;
        for (const std::string& each : names)
            known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", each);
        table.error(key, fmt::format("must name one body; the bodies are {}", known));
        return index;
    }
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

void read_geometry(const Section& table, ImpactPlan& plan) {
    if (table.has("angle") && table.has("offset")) table.error("offset", "give angle or offset, not both");
    if (table.has("offset")) plan.offset = table.number("offset", "m", {}, not_negative);
    if (table.has("angle") || !plan.offset)
        plan.angle = table.number("angle", "rad", 0.0, {0, std::numbers::pi / 2});
    if (table.has("distance") && table.has("gap")) table.error("gap", "give distance or gap, not both");
    if (table.has("distance")) plan.distance = table.number("distance", "m", {}, positive);
    if (table.has("gap") || !plan.distance) plan.gap = table.number("gap", "1", 1.0, not_negative);
}

}  // namespace

std::optional<ImpactPlan> read_impact(const Section& root, const std::vector<std::string>& names,
                                      int dimension) {
    const Section table = root.section("impact");
    if (!table.exists()) return {};
    ImpactPlan plan;
    if (names.size() < 2) {
        table.error("", "an impact needs two bodies");
        return {};
    }
    plan.target = read_participant(table, "target", names, 0);
    plan.impactor = read_participant(table, "impactor", names, plan.target == 1 ? 0 : 1);
    if (plan.target == plan.impactor) {
        table.error("impactor", "must be another body than the target");
        return {};
    }
    plan.speed = table.number("speed", "m/s", {}, positive);
    plan.speed_at_infinity = table.choice("speed_at", {"contact", "infinity"}, "contact") == "infinity";
    read_geometry(table, plan);
    const std::string approach = root.section("gravity").exists() ? "orbit" : "straight";
    plan.along_orbit = table.choice("approach", {"straight", "orbit"}, approach) == "orbit";
    plan.centre_of_mass_frame =
        table.choice("frame", {"centre_of_mass", "target"}, "centre_of_mass") == "centre_of_mass";
    if (dimension < 3 && (plan.along_orbit || plan.speed_at_infinity))
        table.error(plan.along_orbit ? "approach" : "speed_at", "the bodies' gravity needs dimension = 3");
    if (dimension == 1 && (plan.angle != 0 || plan.offset))
        table.error(plan.offset ? "offset" : "angle", "there is only head-on in one dimension");
    return plan;
}

}  // namespace talus
