#include <algorithm>
#include <cmath>

#include "src/analysis/analysis.hpp"

namespace talus {

namespace {

/// The antipode of the point hit, if the scene names one; `body` is the first body that can crack.
std::optional<Antipode> read_antipode(const Section& table, const std::vector<Body>& bodies, std::size_t body,
                                      int dimension) {
    if (!table.has("impact_point")) return {};
    const auto count = static_cast<std::size_t>(dimension);
    std::vector<double> hit = table.numbers("impact_point", "m", count);
    hit.resize(3);
    Antipode antipode{body, {}, {}, 0, bodies[body].velocity};
    const Point middle = centre(bodies[body].shape);
    double distance2 = 0;
    for (std::size_t a = 0; a < count; ++a) distance2 += (middle[a] - hit[a]) * (middle[a] - hit[a]);
    const double distance = std::sqrt(distance2);
    if (!(distance > 0)) {
        table.error("impact_point", "is the centre of the body");
        return {};
    }
    for (std::size_t a = 0; a < count; ++a) {
        antipode.outward[a] = (middle[a] - hit[a]) / distance;
        antipode.point[a] = 2 * middle[a] - hit[a];
    }
    antipode.radius = table.number("antipode_radius", "m", 0.2 * distance, {0, 1e30, true});
    return antipode;
}

/// One linking length a body [m]; 0 for those that are not looked at.
template <class Looks>
std::vector<double> linking_lengths(const std::vector<Body>& bodies, double spacings, Looks&& looks_at) {
    std::vector<double> lengths;
    for (std::size_t b = 0; b < bodies.size(); ++b)
        lengths.push_back(looks_at(b) ? spacings * bodies[b].spacing : 0);
    return lengths;
}

RemnantRules read_remnants(const Section& table, const std::vector<Body>& bodies, const Setup& setup,
                           const FragmentRules& all_matter) {
    const auto end = setup.box.boundary.begin() + setup.box.dimension;
    if (setup.box.dimension != 3 ||
        std::any_of(setup.box.boundary.begin(), end, [](Boundary b) { return b != Boundary::open; }))
        table.error("remnants", "needs dimension = 3 and box.boundaries that are all \"open\"");
    RemnantRules rules;
    rules.binding.count = static_cast<std::size_t>(table.integer("remnant_count", 2, 1, 250));
    rules.binding.constant = setup.gravity ? setup.gravity->constant : newton_constant;
    rules.particles_bind = table.choice("binding", {"groups", "particles"}, "groups") == "particles";
    rules.groups = all_matter;
    for (const Body& body : bodies) rules.spacing.push_back(body.spacing);
    return rules;
}

}  // namespace

AnalysisPlan read_analysis(const Section& table, const std::vector<Body>& bodies, const Setup& setup) {
    AnalysisPlan plan;
    if (!table.exists()) return plan;
    plan.fragments = table.flag("fragments", true);
    const bool remnants = table.flag("remnants", setup.gravity.has_value());
    const double spacings = table.number("linking_length", "1", default_linking_length, {1, 10});
    const auto cracks = [&](std::size_t b) { return setup.materials[b].fracture.has_value(); };
    const auto moves = [&](std::size_t b) { return setup.held.empty() || !setup.held[b]; };
    const FragmentRules all_matter{1, linking_lengths(bodies, spacings, moves), true};
    if (plan.fragments) {
        std::size_t first = 0;
        while (first < bodies.size() && !cracks(first)) ++first;
        const bool any_cracks = first < bodies.size();
        const bool looks_at_cracks = any_cracks && !setup.gravity;  // else all ends as rubble
        const bool undamaged =
            table.choice("link", {"undamaged", "all"}, looks_at_cracks ? "undamaged" : "all") == "undamaged";
        const double threshold = table.number("damage_threshold", "1", 1.0, {0, 1, true});
        if (undamaged && !any_cracks) table.error("link", "no body has a material that cracks");
        plan.rules =
            undamaged ? FragmentRules{threshold, linking_lengths(bodies, spacings, cracks)} : all_matter;
        if (bodies.empty()) return plan;
        plan.antipode = read_antipode(table, bodies, any_cracks ? first : 0, setup.box.dimension);
    }
    if (remnants) plan.remnants = read_remnants(table, bodies, setup, all_matter);
    return plan;
}

}  // namespace talus
