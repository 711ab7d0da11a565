#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "physics/dem/laws/kinematics.hpp"
#include "physics/dem/walls/motion.hpp"
#include "physics/dem/walls/shapes.hpp"
#include "physics/dem/walls/triangle_surface.hpp"

namespace talus::dem {

using WallShape = std::variant<PlaneShape, ContainerShape, BlockShape, RevolvedShape,
                               std::shared_ptr<const TriangleSurface>>;

/// Something that grains meet and that moves as it is told.
struct Wall {
    std::string name;
    std::uint8_t material;  ///< index
    WallShape shape;        ///< as at rest
    WallMotion motion;
};

/// A sphere's contact with a wall, in space: what wall_kinematics() asks for.
struct WallContact {
    Vector3<> normal;         ///< unit vector from the wall to the grain
    double overlap;           ///< [m], negative across a gap
    Vector3<> point;          ///< where they touch: contact_arm() from the centre [m]
    Vector3<> wall_velocity;  ///< there [m/s]
    std::uint32_t place;      ///< names the contact on this wall (surface_contact.hpp)
};

/// Room to search in, kept from one search to the next.
struct WallSearch {
    std::vector<std::uint32_t> triangles;
    std::vector<TriangleSurface::Nearest> nearest;
    std::vector<SurfaceContact> contacts;
};

/// All contacts of a sphere with a wall, and gaps of up to `reach` [m]; replaces what `found` held.
void find_wall_contacts(const Wall& wall, const WallPose& pose, const Vector3<>& centre, double radius,
                        double reach, WallSearch& search, std::vector<WallContact>& found);

/// The same with room of its own.
inline void find_wall_contacts(const Wall& wall, const WallPose& pose, const Vector3<>& centre, double radius,
                               double reach, std::vector<WallContact>& found) {
    WallSearch search;
    find_wall_contacts(wall, pose, centre, radius, reach, search, found);
}

/// True if a sphere may come within `reach` of the wall where it is: never false if it does.
bool may_touch(const Wall& wall, const WallPose& pose, const Vector3<>& centre, double radius, double reach);

/// Greatest displacement of any place of a wall within `distance` of `centre` while it moves from one pose to
/// another is not greater than this [m]: what a list of grains near the wall must allow for.
double greatest_displacement(const WallPose& from, const WallPose& to, const Vector3<>& centre,
                             double distance);

}  // namespace talus::dem
