#include "src/setup/body_checks.hpp"

#include <fmt/format.h>

namespace talus {

void refuse_outside(const Section& table, const Body& body, const Box& box) {
    const BoxShape around = bounds(body.shape, box.dimension);
    for (int axis = 0; axis < box.dimension; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        if (box.boundary[a] != Boundary::open &&
            (around.lower[a] < box.lower[a] || around.upper[a] > box.upper[a]))
            table.error("shape",
                        fmt::format("reaches out of the box along {}, where it is closed", "xyz"[a]));
    }
}

void refuse_too_many_places(const std::vector<Section>& tables, const std::vector<Body>& bodies,
                            int dimension) {
    constexpr double most = 1e10;
    for (std::size_t b = 0; b < tables.size(); ++b) {
        const BoxShape around = bounds(bodies[b].shape, dimension);
        double places = 1;
        for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a)
            places *= (around.upper[a] - around.lower[a]) / bodies[b].spacing;
        if (!(places < most))
            tables[b].error(
                "", fmt::format("has {:.3g} places for particles {:.3g} m apart (allowed: below {:.0e})",
                                places, bodies[b].spacing, most));
    }
}

void refuse_empty_bodies(const std::vector<Section>& tables, const std::vector<Body>& bodies,
                         const std::vector<BodyCensus>& census) {
    for (std::size_t b = 0; b < bodies.size(); ++b)
        if (census[b].count == 0)
            tables[b].error(
                tables[b].has("particles") ? "particles" : "spacing",
                fmt::format("body '{}' has no particles: none of its lattice, {:.4g} m apart, lies "
                            "inside; make it finer or give the body a spacing of its own",
                            bodies[b].name, bodies[b].spacing));
}

void refuse_overlaps(const std::vector<Section>& tables, const std::vector<Body>& bodies, int dimension,
                     const std::function<bool(std::size_t, std::size_t)>& may) {
    for (std::size_t b = 0; b < bodies.size(); ++b)
        for (std::size_t other = 0; other < b; ++other)
            if (!(may && may(other, b)) && overlap(bodies[other], bodies[b], dimension))
                tables[b].error(
                    "", fmt::format("body '{}' overlaps body '{}'", bodies[b].name, bodies[other].name));
}

}  // namespace talus
