#include "physics/dem/walls/shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace talus::dem {

void PlaneShape::find_contacts(const Vector3<>& centre, double reach,
                               std::vector<SurfaceContact>& contacts) const {
    const double distance = dot(centre - point, normal);
    if (distance < reach) contacts.push_back({normal, distance, 0});
}

void ContainerShape::find_contacts(const Vector3<>& centre, double reach,
                                   std::vector<SurfaceContact>& contacts) const {
    const auto touch = [&](double distance, const Vector3<>& normal, std::uint32_t place) {
        if (distance < reach) contacts.push_back({normal, distance, place});
    };
    touch(centre.x - lower.x, {1, 0, 0}, 0);
    touch(upper.x - centre.x, {-1, 0, 0}, 1);
    touch(centre.y - lower.y, {0, 1, 0}, 2);
    touch(upper.y - centre.y, {0, -1, 0}, 3);
    touch(centre.z - lower.z, {0, 0, 1}, 4);
    touch(upper.z - centre.z, {0, 0, -1}, 5);
}

void BlockShape::find_contacts(const Vector3<>& centre, double reach,
                               std::vector<SurfaceContact>& contacts) const {
    const Vector3<> nearest{std::clamp(centre.x, lower.x, upper.x), std::clamp(centre.y, lower.y, upper.y),
                            std::clamp(centre.z, lower.z, upper.z)};
    const Vector3<> arm = centre - nearest;
    const double distance = norm(arm);
    if (distance > 0) {
        if (distance < reach) contacts.push_back({(1 / distance) * arm, distance, 0});
        return;
    }
    // The centre is within: out through the nearest face.
    std::vector<SurfaceContact> faces;
    ContainerShape{lower, upper}.find_contacts(centre, norm(upper - lower), faces);
    const SurfaceContact& face = *std::ranges::min_element(faces, {}, &SurfaceContact::distance);
    contacts.push_back({-face.normal, -face.distance, 0});
}

RevolvedShape::RevolvedShape(const Vector3<>& origin, const Vector3<>& axis,
                             std::vector<ProfilePoint> profile, double smooth_angle)
    : origin_(origin), axis_(axis), profile_(std::move(profile)) {
    const auto direction = [&](std::size_t piece) {
        const double r = profile_[piece + 1].radius - profile_[piece].radius,
                     z = profile_[piece + 1].along - profile_[piece].along, length = std::hypot(r, z);
        return std::array{r / length, z / length};
    };
    part_.assign(profile_.size() - 1, 0);
    for (std::size_t piece = 1; piece < part_.size(); ++piece) {
        const auto before = direction(piece - 1), here = direction(piece);
        const bool smooth = before[0] * here[0] + before[1] * here[1] > std::cos(smooth_angle);
        part_[piece] = part_[piece - 1] + (smooth ? 0 : 1);
    }
}

void RevolvedShape::find_contacts(const Vector3<>& centre, double reach,
                                  std::vector<SurfaceContact>& contacts) const {
    const Vector3<> arm = centre - origin_;
    const double along = dot(arm, axis_);
    const Vector3<> across = arm - along * axis_;
    const double radius = norm(across);
    Vector3<> outwards = radius > 0 ? (1 / radius) * across : Vector3<>{};
    if (radius == 0) {  // any direction serves: both sides of the axis answer alike
        const Vector3<> side =
            cross(axis_, std::abs(axis_.x) < 0.5 ? Vector3<>{1, 0, 0} : Vector3<>{0, 1, 0});
        outwards = (1 / norm(side)) * side;
    }
    const std::size_t begin = contacts.size();
    const bool within = touch_profile(radius, along, outwards, reach, contacts);
    if (within) touch_profile(-radius, along, outwards, reach, contacts);  // the other side of the axis
    unite_smooth_contacts(contacts, begin);
}

RevolvedShape::Nearest RevolvedShape::nearest_on(std::size_t piece, double radius, double along) const {
    const ProfilePoint &a = profile_[piece], &b = profile_[piece + 1];
    const double br = b.radius - a.radius, bz = b.along - a.along, length = std::hypot(br, bz);
    const double ar = radius - a.radius, az = along - a.along, t = ar * br + az * bz;
    const auto from = [&](double r, double z, Feature feature) {
        const double distance = std::hypot(r, z);
        return distance > 0 ? Nearest{feature, distance, r / distance, z / distance}
                            : Nearest{feature, 0, -bz / length, br / length};
    };
    if (t <= 0) return from(ar, az, Feature::start);
    if (t >= length * length) return from(radius - b.radius, along - b.along, Feature::end);
    const double height = (az * br - ar * bz) / length, sign = height < 0 ? -1 : 1;
    return {Feature::between, sign * height, -sign * bz / length, sign * br / length};
}

bool RevolvedShape::touch_profile(double radius, double along, const Vector3<>& outwards, double reach,
                                  std::vector<SurfaceContact>& contacts) const {
    bool within = false;
    for (std::size_t piece = 0; piece < part_.size(); ++piece) {
        const Nearest here = nearest_on(piece, radius, along);
        // A joint is a contact if it is the nearest place of both pieces, and the first of them tells of it.
        const bool is_start = here.feature == Feature::start, is_end = here.feature == Feature::end;
        if (is_start && piece > 0) continue;
        if (is_end && piece + 1 < part_.size() &&
            nearest_on(piece + 1, radius, along).feature != Feature::start)
            continue;
        // What lies on the axis is told of by the centre's own side.
        const double end_radius = profile_[piece + (is_end ? 1 : 0)].radius;
        if (radius < 0 && here.feature != Feature::between && end_radius == 0) continue;
        if (!(here.distance < reach)) continue;
        const double side = std::signbit(radius) ? -1 : 1;
        contacts.push_back(
            {(side * here.towards_r) * outwards + here.towards_z * axis_, here.distance, part_[piece]});
        within = within || here.towards_r < 0;
    }
    return within;
}

}  // namespace talus::dem
