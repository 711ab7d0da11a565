#include "src/setup/flow_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "src/setup/clump_reader.hpp"
#include "src/setup/names.hpp"

namespace talus {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Range positive{0, infinity, true};

/// When a source or a sink acts, and how often.
template <class Item>
void read_times(const Section& table, Item& item) {
    constexpr std::int64_t usual_interval = 100;
    item.begin = table.number("begin", "s", 0.0);
    if (table.has("end")) item.end = table.number("end", "s");
    if (item.end < item.begin) table.error("end", "must not be before begin");
    item.interval = static_cast<std::uint64_t>(table.integer("interval", usual_interval, 1, 1'000'000'000));
}

/// One of two keys, of which the second is by mass.
double read_amount(const Section& table, std::string_view by_number, std::string_view by_mass,
                   std::string_view unit_of_number, std::string_view unit_of_mass, bool& is_mass) {
    is_mass = table.has(by_mass);
    if (is_mass && table.has(by_number))
        table.error(by_mass, fmt::format("give {} or {}, not both", by_number, by_mass));
    return is_mass ? table.number(by_mass, unit_of_mass, {}, positive)
                   : table.number(by_number, unit_of_number, {}, positive);
}

GrainSource read_source(const Section& table, const BodyContext& context, GrainBody& body) {
    GrainSource source;
    source.name = body.name;
    source.density = body.material.density;
    if (table.has("clump")) {
        read_clump(context.scene, table, body);
        source.clump = body.clump;
        source.turned = body.turned;
    } else {
        source.sizes = body.sizes = read_grain_sizes(table);
        body.least_radius = body.sizes.least;
        body.greatest_radius = body.sizes.greatest;
    }
    source.region = read_shape(table, body.material.density, context);
    source.velocity = body.velocity = origin_default(table, "velocity", "m/s", 3);
    source.angular_velocity = body.angular_velocity = origin_default(table, "angular_velocity", "rad/s", 3);
    source.rate = read_amount(table, "rate", "mass_rate", "1/s", "kg/s", source.by_mass);
    if (table.has("number") || table.has("total_mass")) {
        bool total_by_mass = false;
        source.total = read_amount(table, "number", "total_mass", "1", "kg", total_by_mass);
        if (total_by_mass != source.by_mass)
            table.error(total_by_mass ? "total_mass" : "number",
                        "rate goes with number, mass_rate with total_mass");
    }
    source.tries = static_cast<int>(table.integer("tries", 20, 1, 1000));
    read_times(table, source);
    return source;
}

}  // namespace

GrainRegion read_region(const Section& table, const BodyContext& context) {
    GrainRegion region;
    if (table.has("shape") && table.text("shape") == "plane") {
        HalfSpace half{read_point(table, "point", "m", 3), read_point(table, "normal", "1", 3)};
        if (!(norm(half.normal) > 0)) table.error("normal", "must have a length above 0");
        for (std::size_t a = 0; a < 3; ++a)
            if (context.boundaries[a] == Boundary::periodic && half.normal[a] != 0)
                table.error("normal", fmt::format("must be 0 along {}, where the box is periodic", "xyz"[a]));
        region.shape = half;
    } else {
        region.shape = read_shape(table, 1, context);
    }
    region.outside = table.flag("outside", false);
    return region;
}

std::optional<GrainSettling> read_settling(const Section& root, double time_step, const GrainFlowPlan& flow,
                                           const std::vector<dem::Wall>& walls) {
    const Section table = root.section("settle");
    if (!table.exists()) return {};
    GrainSettling settling;
    settling.imbalance = table.number("imbalance", "1", settling.imbalance, positive);
    settling.lasting = static_cast<int>(table.integer("lasting", settling.lasting, 1, 1'000'000));
    settling.interval = static_cast<std::uint64_t>(
        table.integer("interval", static_cast<std::int64_t>(settling.interval), 1, 1'000'000'000));
    settling.longest = table.number("longest", "s", {}, positive);
    settling.damping = table.number("damping", "s", settling.damping, {0});
    if (settling.longest < 2 * static_cast<double>(settling.interval) * time_step)
        table.error("longest", fmt::format("is shorter than two looks, {:.4g} s",
                                           2 * static_cast<double>(settling.interval) * time_step));
    const std::vector<Section> sources = root.sections("source"), tables = root.sections("wall");
    for (std::size_t s = 0; s < sources.size(); ++s)
        if (flow.sources[s].begin < 0 && !(flow.sources[s].total < infinity))
            sources[s].error("begin",
                             "a source that begins before time 0, while grains settle, must say how "
                             "much it inserts in all");
    for (std::size_t w = 0; w < tables.size(); ++w)
        if (walls[w].motion.begin < 0)
            tables[w].section("motion").error("begin", "must not be before time 0, while grains settle");
    return settling;
}

std::vector<WatchedRegion> read_regions(const Section& root, const BodyContext& context) {
    std::vector<WatchedRegion> regions;
    for (const Section& table : root.sections("region")) {
        WatchedRegion region;
        region.name = table.text("name", table.path());
        refuse_same_name(table, regions, region.name);
        region.shape = read_shape(table, 1, context);
        region.stress = table.flag("stress", true);
        regions.push_back(std::move(region));
    }
    return regions;
}

GrainFlowPlan read_flow(const Section& root, const BodyContext& context, GrainLawReader& laws,
                        std::vector<GrainBody>& bodies, std::vector<std::uint8_t>& materials) {
    GrainFlowPlan plan;
    plan.seed = context.seed;
    for (const Section& table : root.sections("sink")) {
        GrainSink sink;
        sink.name = table.text("name", table.path());
        refuse_same_name(table, plan.sinks, sink.name);
        sink.region = read_region(table, context);
        read_times(table, sink);
        plan.sinks.push_back(std::move(sink));
    }
    for (const Section& table : root.sections("source")) {
        GrainBody body;
        body.name = table.text("name", table.path());
        refuse_same_name(table, bodies, body.name);
        materials.push_back(laws.material(table));
        body.material = laws.materials()[materials.back()];
        body.inserted = true;
        GrainSource source = read_source(table, context, body);
        source.body = static_cast<std::uint8_t>(bodies.size());
        plan.sources.push_back(std::move(source));
        bodies.push_back(std::move(body));
    }
    if (bodies.size() > 255) root.error("source", "more than 255 bodies of grains");
    return plan;
}

}  // namespace talus
