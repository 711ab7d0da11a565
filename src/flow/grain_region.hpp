#pragma once
#include <variant>

#include "domain/box.hpp"
#include "domain/particles.hpp"
#include "physics/dem/clumps/clump_motion.hpp"
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

/// Centre of a grain, or of the clump that it is a sphere of, as if it had been brought back into the box:
/// that is done with a new list of pairs, which must not matter [m].
Point place_in_box(const ParticleSet& grains, std::size_t i, const Box& box, const dem::ClumpMotion& clumps);
/// The same of a sphere of a clump itself.
Point sphere_in_box(const ParticleSet& grains, std::size_t i, const Box& box);

}  // namespace talus
