#include "src/setup/gravity_reader.hpp"

namespace talus {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// What all kinds of particles have in common.
gravity::Settings read_tree(const Section& table, const Box& box) {
    if (box.dimension != 3) table.error("", "self-gravity needs dimension = 3");
    for (const Boundary boundary : box.boundary)
        if (boundary != Boundary::open) {
            table.error("", "self-gravity needs box.boundaries that are all \"open\"");
            break;
        }
    gravity::Settings settings;
    settings.constant = table.number("constant", "m3 kg-1 s-2", settings.constant, {0, infinity, true});
    settings.direct = table.flag("direct", false);
    if (settings.direct) return settings;
    settings.theta = table.number("theta", "1", settings.theta, {0, 0.95, true});
    if (table.choice("opening", {"geometric", "relative"}, "geometric") == "relative") {
        settings.opening = gravity::Opening::relative;
        settings.accuracy = table.number("accuracy", "1", settings.accuracy, {0, 1, true});
    }
    settings.order = static_cast<int>(table.integer("order", settings.order, 1, 3));
    if (table.choice("precision", {"single", "double"}, "single") == "double")
        settings.precision = gravity::Precision::double_precision;
    return settings;
}

}  // namespace

std::optional<gravity::Settings> read_gravity(const Section& root, const Box& box) {
    const Section table = root.section("gravity");
    if (!table.exists()) return {};
    gravity::Settings settings = read_tree(table, box);
    if (table.has("softening_length"))
        settings.softening_length = table.number("softening_length", "m", {}, {0, infinity, true});
    settings.step_factor = table.number("step_factor", "1", settings.step_factor, {0, 2, true});
    return settings;
}

std::optional<SelfGravity> read_grain_gravity(const Section& root, const Box& box) {
    const Section table = root.section("gravity");
    if (!table.exists()) return {};
    SelfGravity plan{read_tree(table, box)};
    plan.interval = static_cast<int>(table.integer("interval", plan.interval, 1, 1000000));
    return plan;
}

}  // namespace talus
