#pragma once
#include <cstdint>
#include <vector>

#include "physics/dem/walls/surface_contact.hpp"

namespace talus::dem {

// Shapes of walls. find_contacts() appends the contacts of a sphere about `centre` nearer than `reach`.

/// Half space behind a plane without end: distances are negative in it.
struct PlaneShape {
    Vector3<> point;   ///< on the plane [m]
    Vector3<> normal;  ///< unit vector to the side of the grains

    void find_contacts(const Vector3<>& centre, double reach, std::vector<SurfaceContact>& contacts) const;
};

/// A box along the axes with the grains in it: six half spaces, each touched on its own.
struct ContainerShape {
    Vector3<> lower, upper;  ///< corners [m]

    void find_contacts(const Vector3<>& centre, double reach, std::vector<SurfaceContact>& contacts) const;
};

/// A solid box along the axes with the grains around it; edges and corners are round to a sphere that
/// touches.
struct BlockShape {
    Vector3<> lower, upper;  ///< corners [m]

    void find_contacts(const Vector3<>& centre, double reach, std::vector<SurfaceContact>& contacts) const;
};

/// A sheet that a polyline makes as it turns about an axis; grains may be on either side. Two points of equal
/// radius make a tube (a cylinder), of radius zero and another a disk or cone, four a drum with its ends or a
/// silo with its hopper. Where pieces meet nothing is counted twice, as on a sheet of triangles. A sphere
/// that fills the sheet, near the axis, touches on both sides of the axis.
class RevolvedShape {
  public:
    struct ProfilePoint {
        double radius, along;  ///< from and along the axis [m]
    };
    /// `axis` is a unit vector; radii are not negative, no two points in sequence the same. Pieces meeting at
    /// less than `smooth_angle` [rad] are one smooth part.
    RevolvedShape(const Vector3<>& origin, const Vector3<>& axis, std::vector<ProfilePoint> profile,
                  double smooth_angle);

    void find_contacts(const Vector3<>& centre, double reach, std::vector<SurfaceContact>& contacts) const;

  private:
    enum class Feature : std::uint8_t { start, between, end };
    /// Where a piece is nearest to a point of the half plane, and the unit vector from there to the point.
    struct Nearest {
        Feature feature;
        double distance, towards_r, towards_z;
    };
    Nearest nearest_on(std::size_t piece, double radius, double along) const;
    /// Contacts in one half plane, negative radii being those of the other side; whether one of them is
    /// touched from the side of the axis.
    bool touch_profile(double radius, double along, const Vector3<>& outwards, double reach,
                       std::vector<SurfaceContact>& contacts) const;

    Vector3<> origin_, axis_;
    std::vector<ProfilePoint> profile_;
    std::vector<std::uint32_t> part_;  // of each piece
};

}  // namespace talus::dem
