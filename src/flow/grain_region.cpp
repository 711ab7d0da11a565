#include "src/flow/grain_region.hpp"

#include "domain/boundary.hpp"
#include "domain/clump_fields.hpp"
#include "domain/grain_fields.hpp"

namespace talus {

bool GrainRegion::contains(const Point& place) const {
    const auto* half = std::get_if<HalfSpace>(&shape);
    const bool within = half ? dot(minus(place, half->point), half->normal) < 0
                             : talus::contains(std::get<BodyShape>(shape), place, 3);
    return within != outside;
}

namespace {

Point in_box(const ParticleSet& grains, const Field<double>& field, std::size_t i, const Box& box) {
    Point place{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        place[a] = grains.data(field, axis)[i];
        if (box.boundary[a] == Boundary::periodic) place[a] = wrapped(place[a], box.lower[a], box.upper[a]);
    }
    return place;
}

}  // namespace

Point place_in_box(const ParticleSet& grains, std::size_t i, const Box& box, const dem::ClumpMotion& clumps) {
    const bool in_clump = clumps.of_body(grains.data(field::body)[i]) != nullptr;
    return in_box(grains, in_clump ? field::clump_centre : field::position, i, box);
}

Point sphere_in_box(const ParticleSet& grains, std::size_t i, const Box& box) {
    return in_box(grains, field::position, i, box);
}

}  // namespace talus
