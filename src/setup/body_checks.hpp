#pragma once
#include <functional>
#include <vector>

#include "domain/box.hpp"
#include "io/scene.hpp"
#include "src/setup/bodies.hpp"

namespace talus {

/// Records bodies around which there are more places for particles than can be gone through one by one.
void refuse_too_many_places(const std::vector<Section>& tables, const std::vector<Body>& bodies,
                            int dimension);

/// Records bodies without particles, one table each.
void refuse_empty_bodies(const std::vector<Section>& tables, const std::vector<Body>& bodies,
                         const std::vector<BodyCensus>& census);

/// Records a body that reaches out of the box where that is closed.
void refuse_outside(const Section& table, const Body& body, const Box& box);

/// Records bodies of which one has particles inside another, but for pairs that `may`.
void refuse_overlaps(const std::vector<Section>& tables, const std::vector<Body>& bodies, int dimension,
                     const std::function<bool(std::size_t, std::size_t)>& may = {});

}  // namespace talus
