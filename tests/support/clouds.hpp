#pragma once
#include <string>
#include <vector>

#include "domain/box.hpp"
#include "domain/cell_grid.hpp"
#include "domain/particles.hpp"

/// Clouds of points with fields of every shape, whose values follow from the particle's id.
namespace talus::test {

struct Cloud {
    std::string name;
    Box box;
    double radius;  ///< within which particles are partners
    std::vector<std::array<double, 3>> points;
};

/// Points of every kind: spread evenly, on a lattice whose partners lie on the borders of cells, crowded on a
/// logarithmic scale, all in one cell, all in a corner, with fragments far away; 1D to 3D; axes open,
/// periodic and reflecting, down to boxes as narrow as the radius.
std::vector<Cloud> all_clouds();

/// Adds the fields, those with Role::state filled, to a set of the points that `keep(k)` chooses. Ids are not
/// in the order of the points. The mass is the id, so that copies can be told.
ParticleSet make_particles(const Cloud& cloud, const std::vector<std::size_t>& keep);
std::vector<std::size_t> all_points(const Cloud& cloud);

/// Value of a component of a field of the particle with this id.
double value_of(const FieldInfo& field, int component, std::uint64_t id);
/// Fills the own particles' values of all fields of role `role` but id, position, mass with value_of().
void fill_values(ParticleSet& particles, Role role);

/// An original or image of a particle near another.
struct Sighting {
    std::uint64_t id;
    std::array<double, 3> position;
    std::array<bool, 3> flip;
    auto operator<=>(const Sighting&) const = default;
};
struct Point {
    std::uint64_t id;
    std::array<double, 3> position;
};
/// What a particle at `centre` interacts with, by looking at every image of every point; sorted.
std::vector<Sighting> brute_force(const Cloud& cloud, const std::vector<Point>& points, const Point& centre);

/// How many own cells a cell of `grid` reaches, in tests: cells a radius.
inline constexpr int cells_per_radius = 2;

}  // namespace talus::test
