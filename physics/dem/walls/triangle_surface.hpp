#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "physics/dem/walls/surface_contact.hpp"

namespace talus::dem {

/// Corners of triangles, shared between neighbours.
struct TriangleMesh {
    using Triangle = std::array<std::uint32_t, 3>;
    std::vector<Vector3<>> vertices;  ///< [m]
    std::vector<Triangle> triangles;
};

/// What may be wrong with a mesh.
struct MeshDefects {
    std::size_t without_area = 0;   ///< triangles thinner than 1e-9 of their length
    std::size_t open_edges = 0;     ///< with one triangle: a rim or a hole
    std::size_t crowded_edges = 0;  ///< with more than two
    Vector3<> open_edge;            ///< middle of one of the open edges [m]
};
MeshDefects find_defects(const TriangleMesh& mesh);

/// Takes the triangles without area out of a mesh.
void remove_triangles_without_area(TriangleMesh& mesh);

/// A sheet of triangles that spheres touch from either side. Each place where the distance to the sphere's
/// centre is least near by is one contact, be it in a face, on an edge or at a vertex: none is counted twice,
/// a flat part is touched like a plane, and over a convex edge the distance and the normal change
/// continuously. Faces meeting at less than `smooth_angle` are one smooth part (surface_contact.hpp).
class TriangleSurface {
  public:
    /// `usual_reach`: distance that it will mostly be asked for [m]. Triangles must have an area.
    TriangleSurface(TriangleMesh mesh, double smooth_angle, double usual_reach);

    /// Triangles that may be nearer than `reach` to `centre`, in order: all that are, and some more.
    void near(const Vector3<>& centre, double reach, std::vector<std::uint32_t>& found) const;

    enum class Feature : std::uint8_t { face, edge, vertex };
    /// Where a triangle is nearest to a centre.
    struct Nearest {
        std::uint32_t triangle, feature_index;
        Feature feature;
        double distance;  ///< [m]
        Vector3<> arm;    ///< from there to the centre [m]
    };

    /// Appends the contacts nearer than `reach` to `centre` among `triangles`, which near() found for this
    /// centre, or for another with a reach greater by more than their distance.
    /// `nearest` is room to work in.
    void find_contacts(std::span<const std::uint32_t> triangles, const Vector3<>& centre, double reach,
                       std::vector<Nearest>& nearest, std::vector<SurfaceContact>& contacts) const;

    const TriangleMesh& mesh() const { return mesh_; }
    const Vector3<>& lower() const { return lower_; }
    const Vector3<>& upper() const { return upper_; }
    /// Number of smooth parts.
    std::uint32_t part_count() const { return part_count_; }

  private:
    Nearest nearest_on(std::uint32_t triangle, const Vector3<>& centre) const;
    bool is_contact(const Nearest& candidate, std::span<const Nearest> all) const;
    void find_edges();
    void find_parts(double smooth_angle);
    void fill_cells(double usual_reach);
    template <class Visit>
    void for_each_cell(const Vector3<>& low, const Vector3<>& high, Visit&& visit) const;

    /// Lists of triangles of edges, vertices or cells, one after the other.
    struct Lists {
        std::vector<std::uint32_t> start, items;
        std::span<const std::uint32_t> operator[](std::size_t k) const {
            return {items.data() + start[k], start[k + 1] - start[k]};
        }
    };

    TriangleMesh mesh_;
    std::vector<Vector3<>> normals_;
    std::vector<std::array<std::uint32_t, 3>> edges_;  // of a triangle, from corner k to the next
    std::vector<std::array<std::uint32_t, 2>> ends_;   // of an edge
    Lists of_edge_, of_vertex_, of_cell_;
    std::vector<std::uint32_t> part_;
    std::uint32_t part_count_ = 0;
    Vector3<> lower_, upper_;
    double cells_per_metre_ = 0;
    std::array<std::int64_t, 3> cells_{};
};

}  // namespace talus::dem
