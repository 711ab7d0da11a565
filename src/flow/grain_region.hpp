#pragma once
#include <variant>

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

    bool contains(const Point& place) const {
        const auto* half = std::get_if<HalfSpace>(&shape);
        const bool within = half ? dot(minus(place, half->point), half->normal) < 0
                                 : talus::contains(std::get<BodyShape>(shape), place, 3);
        return within != outside;
    }
};

}  // namespace talus
