#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "src/setup/point.hpp"

namespace talus {

/// Surface of triangles; seen from outside their corners run counter-clockwise.
struct Polyhedron {
    using Triangle = std::array<std::uint32_t, 3>;
    std::vector<Point> vertices;  ///< [m]
    std::vector<Triangle> triangles;
};

/// Volume integrals of the inside of a closed surface of unit density.
struct VolumeIntegrals {
    double volume;                        ///< [m3], negative if the triangles are seen from inside
    Point centroid;                       ///< [m]
    std::array<Point, 3> second_moments;  ///< of x_a x_b about the centroid [m5]
};
VolumeIntegrals integrate(const Polyhedron& surface);

/// Why a surface encloses no volume: how many edges have not as many triangles on one side as on the other,
/// and where the first of them is. Empty if it is closed and its triangles are oriented alike.
std::string why_not_closed(const Polyhedron& surface);

/// A closed surface that can be asked for its inside in a time that does not grow with its number of
/// triangles.
class SurfaceMesh {
  public:
    /// `surface` must be closed.
    explicit SurfaceMesh(Polyhedron surface);

    /// Where a line along x crosses the surface: `sign` is +1 where it leaves, -1 where it enters.
    struct Crossing {
        double x;
        int sign;
    };
    /// All crossings of the line through (y, z), in order of triangles. Lines through edges and vertices are
    /// treated as if moved aside a little, all triangles in the same way, so that the signs sum to zero.
    void crossings(double y, double z, std::vector<Crossing>& found) const;
    /// How often the surface winds around a point: 1 inside, 0 outside, more where parts of it overlap.
    int winding_number(const Point& point) const;

    const Polyhedron& polyhedron() const { return surface_; }
    const VolumeIntegrals& integrals() const { return integrals_; }
    const Point& lower() const { return lower_; }
    const Point& upper() const { return upper_; }

  private:
    template <class Visit>
    void for_each_crossing(double y, double z, Visit&& visit) const;
    std::size_t bin_along(std::size_t axis, double coordinate) const;

    Polyhedron surface_;
    VolumeIntegrals integrals_;
    Point lower_{}, upper_{};
    std::array<std::size_t, 3> bins_{};              // along y and z
    Point bins_per_metre_{};                         // along y and z
    std::vector<std::uint32_t> bin_start_, in_bin_;  // triangles whose shadow along x touches a bin
};

}  // namespace talus
