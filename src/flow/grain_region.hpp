#pragma once
#include <variant>

#include "domain/box.hpp"
#include "domain/particles.hpp"
#include "src/setup/shapes.hpp"

namespace talus {

/// Half of space: behind the plane through `point`, where `normal` does not point to.
struct HalfSpace {
    Point point, normal;
};

/// Part of space that a scene names.
struct GrainRegion {
    std::variant<HalfSpace, BodyShape> shape;
    bool outside = false;  ///< all but the shape

    bool contains(const Point& place) const;
};

/// Centre of a grain as if it had been brought back into the box: that is done with a new list of pairs,
/// which must not matter [m].
Point place_in_box(const ParticleSet& grains, std::size_t i, const Box& box);

}  // namespace talus
