#include "physics/dem/walls/wall.hpp"

#include <algorithm>
#include <cmath>

namespace talus::dem {

namespace {

/// Finds the contacts in the wall's own frame.
void touch(const WallShape& shape, const Vector3<>& centre, double reach, WallSearch& search) {
    search.contacts.clear();
    if (const auto* surface = std::get_if<std::shared_ptr<const TriangleSurface>>(&shape)) {
        (*surface)->near(centre, reach, search.triangles);
        if (!search.triangles.empty())
            (*surface)->find_contacts(search.triangles, centre, reach, search.nearest, search.contacts);
        return;
    }
    const auto find = [&](const auto& simple) {
        if constexpr (requires { simple.find_contacts(centre, reach, search.contacts); })
            simple.find_contacts(centre, reach, search.contacts);
    };
    std::visit(find, shape);
}

}  // namespace

void find_wall_contacts(const Wall& wall, const WallPose& pose, const Vector3<>& centre, double radius,
                        double reach, WallSearch& search, std::vector<WallContact>& found) {
    found.clear();
    touch(wall.shape, pose.in_wall(centre), radius + reach, search);
    for (const SurfaceContact& c : search.contacts) {
        const Vector3<> normal = pose.turned(c.normal);
        const double overlap = radius - c.distance;
        const Vector3<> point = centre - contact_arm(radius, overlap) * normal;
        found.push_back({normal, overlap, point, pose.velocity_at(point), c.place});
    }
}

bool may_touch(const Wall& wall, const WallPose& pose, const Vector3<>& centre, double radius, double reach) {
    const Vector3<> at_rest = pose.in_wall(centre);
    if (const auto* surface = std::get_if<std::shared_ptr<const TriangleSurface>>(&wall.shape)) {
        std::vector<std::uint32_t> triangles;
        (*surface)->near(at_rest, radius + reach, triangles);
        return !triangles.empty();
    }
    WallSearch search;
    touch(wall.shape, at_rest, radius + reach, search);
    return !search.contacts.empty();
}

double greatest_displacement(const WallPose& from, const WallPose& to, const Vector3<>& centre,
                             double distance) {
    // Frobenius' norm of a rotation's difference from the identity is sqrt(2) times the greatest of |R x -
    // x|/|x|.
    double squares = 0;
    for (std::size_t k = 0; k < 3; ++k) squares += dot(to.rows[k] - from.rows[k], to.rows[k] - from.rows[k]);
    const double turn = std::sqrt(0.5 * squares);
    return norm(to.shift - from.shift) + turn * (norm(centre - from.centre - from.shift) + distance);
}

}  // namespace talus::dem
