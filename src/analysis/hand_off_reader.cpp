#include <fmt/format.h>

#include <algorithm>

#include "src/analysis/analysis.hpp"
#include "src/analysis/hand_off.hpp"

namespace talus {

std::optional<HandOffPlan> read_hand_off(const Section& root, const std::vector<Body>& bodies,
                                         const Setup& setup, double end_time) {
    const Section table = root.section("hand_off");
    if (!table.exists()) return {};
    const auto end = setup.box.boundary.begin() + setup.box.dimension;
    if (setup.box.dimension != 3 ||
        std::any_of(setup.box.boundary.begin(), end, [](Boundary b) { return b != Boundary::open; }))
        table.error("", "grains need dimension = 3 and box.boundaries that are all \"open\"");
    if (std::find(setup.held.begin(), setup.held.end(), true) != setup.held.end())
        table.error("", "a body that is held cannot become grains");
    table.choice("to", {"grains"});
    HandOffPlan plan;
    plan.at = table.number("at", "s", end_time, {0});
    if (plan.at > end_time)
        table.error("at", fmt::format("is after the end of the run (allowed: up to {} s)", end_time));
    plan.filling = table.number("filling", "1", 1.0, {0, 1, true});
    for (const Body& body : bodies) plan.density.push_back(body.density);
    const bool cracks = std::any_of(setup.materials.begin(), setup.materials.end(),
                                    [](const Material& material) { return material.fracture.has_value(); });
    const std::string link =
        table.choice("link", {"undamaged", "all", "none"}, cracks ? "undamaged" : "none");
    if (link == "none") return plan;
    if (link == "undamaged" && !cracks) table.error("link", "no body has a material that cracks");
    FragmentRules rules;
    rules.all_matter = link == "all";
    if (!rules.all_matter) rules.damage_threshold = table.number("damage_threshold", "1", 1.0, {0, 1, true});
    const double spacings = table.number("linking_length", "1", default_linking_length, {0.1, 10});
    for (const Body& body : bodies) rules.linking_length.push_back(spacings * body.spacing);
    plan.groups = rules;
    return plan;
}

}  // namespace talus
