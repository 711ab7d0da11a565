#pragma once
#include <cstdint>
#include <vector>

#include "physics/dem/vector3.hpp"

namespace talus::dem {

/// A place where a sphere is near a surface: where the distance to its centre is least, near by on the
/// surface.
struct SurfaceContact {
    Vector3<> normal;     ///< unit vector from the surface to the centre
    double distance;      ///< of the centre from the surface [m]
    std::uint32_t place;  ///< names the contact for what its law remembers: the same while a grain moves over
                          ///< a smooth part of the surface, different for the contacts of one grain
};

/// Greatest angle of two contacts' normals on one smooth part of a surface that count as one [rad].
inline constexpr double one_contact_angle = 0.7853981633974483;

/// Places that each smooth part may have at a time.
inline constexpr std::uint32_t contacts_of_one_part = 8;

/// Makes one of the contacts of each smooth part whose normals are close: a facetted hollow would be touched
/// twice where the curved one it stands for is touched once. `contacts` from `begin` on come with the number
/// of their part as place. Normal and distance become means; the weight of another facet falls from 1, where
/// it is as near as the nearest, d, to 0 at the distance d/cos(angle between them), where it ends at the edge
/// they share: the force is continuous as a facet comes and goes.
void unite_smooth_contacts(std::vector<SurfaceContact>& contacts, std::size_t begin);

}  // namespace talus::dem
