#include "src/setup/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace talus {

namespace {

double ball_volume(double radius, int dimension) {
    using std::numbers::pi;
    if (dimension == 1) return 2 * radius;
    if (dimension == 2) return pi * radius * radius;
    return 4.0 / 3 * pi * radius * radius * radius;
}

/// Squared distance from the centre in units of the semi-axes.
double scaled_distance2(const Point& point, const Point& centre, const Point& semi_axes, int dimension) {
    double sum = 0;
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
        const double d = (point[a] - centre[a]) / semi_axes[a];
        sum += d * d;
    }
    return sum;
}

/// Points of one rectangular cell of a lattice, in units of its edges, and the edges for unit volume per
/// point.
struct LatticeCell {
    Point edges;
    std::vector<Point> points;
};

LatticeCell lattice_cell(Lattice lattice, int dimension) {
    if (lattice == Lattice::close_packed && dimension == 3) {
        const double edge = std::cbrt(4.0);
        return {{edge, edge, edge}, {{.25, .25, .25}, {.75, .75, .25}, {.75, .25, .75}, {.25, .75, .75}}};
    }
    if (lattice == Lattice::close_packed && dimension == 2) {
        const double edge = std::sqrt(2 / std::sqrt(3.0));  // rows of this spacing, sqrt(3)/2 of it apart
        return {{edge, std::sqrt(3.0) * edge, 1}, {{.25, .25, .5}, {.75, .75, .5}}};
    }
    return {{1, 1, 1}, {{.5, .5, .5}}};
}

}  // namespace

bool contains(const BodyShape& shape, const Point& point, int dimension) {
    if (const auto* box = std::get_if<BoxShape>(&shape)) {
        for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a)
            if (point[a] < box->lower[a] || point[a] >= box->upper[a]) return false;
        return true;
    }
    if (const auto* sphere = std::get_if<SphereShape>(&shape)) {
        const double distance2 = scaled_distance2(point, sphere->centre, {1, 1, 1}, dimension);
        return distance2 < sphere->radius * sphere->radius &&
               distance2 >= sphere->inner_radius * sphere->inner_radius;
    }
    const auto& ellipsoid = std::get<EllipsoidShape>(shape);
    return scaled_distance2(point, ellipsoid.centre, ellipsoid.semi_axes, dimension) < 1;
}

double volume(const BodyShape& shape, int dimension) {
    if (const auto* box = std::get_if<BoxShape>(&shape)) {
        double product = 1;
        for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a)
            product *= box->upper[a] - box->lower[a];
        return product;
    }
    if (const auto* sphere = std::get_if<SphereShape>(&shape))
        return ball_volume(sphere->radius, dimension) - ball_volume(sphere->inner_radius, dimension);
    const auto& ellipsoid = std::get<EllipsoidShape>(shape);
    double product = ball_volume(1, dimension);
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) product *= ellipsoid.semi_axes[a];
    return product;
}

BoxShape bounds(const BodyShape& shape, int dimension) {
    if (const auto* box = std::get_if<BoxShape>(&shape)) return *box;
    const Point middle = centre(shape);
    Point extent{};
    if (const auto* sphere = std::get_if<SphereShape>(&shape))
        extent.fill(sphere->radius);
    else
        extent = std::get<EllipsoidShape>(shape).semi_axes;
    BoxShape result{middle, middle};
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
        result.lower[a] -= extent[a];
        result.upper[a] += extent[a];
    }
    return result;
}

Point centre(const BodyShape& shape) {
    if (const auto* sphere = std::get_if<SphereShape>(&shape)) return sphere->centre;
    if (const auto* ellipsoid = std::get_if<EllipsoidShape>(&shape)) return ellipsoid->centre;
    const auto& box = std::get<BoxShape>(shape);
    Point middle{};
    for (std::size_t a = 0; a < 3; ++a) middle[a] = 0.5 * (box.lower[a] + box.upper[a]);
    return middle;
}

void for_each_lattice_point(const BodyShape& shape, Lattice lattice, double spacing, int dimension,
                            const std::function<void(const Point&)>& visit) {
    const LatticeCell cell = lattice_cell(lattice, dimension);
    const BoxShape around = bounds(shape, dimension);
    const bool is_box = std::holds_alternative<BoxShape>(shape);
    Point origin{}, edges{1, 1, 1};
    std::array<long, 3> count{1, 1, 1};
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
        const double length = around.upper[a] - around.lower[a];
        edges[a] = cell.edges[a] * spacing;
        if (is_box) {
            count[a] = std::max(1L, std::lround(length / edges[a]));
            edges[a] = length / static_cast<double>(count[a]);
            origin[a] = around.lower[a];
        } else {
            const auto each_side = static_cast<long>(length / 2 / edges[a]) + 2;
            count[a] = 2 * each_side;
            origin[a] = centre(shape)[a] - static_cast<double>(each_side) * edges[a];
        }
    }
    for (long z = 0; z < count[2]; ++z)
        for (long y = 0; y < count[1]; ++y)
            for (long x = 0; x < count[0]; ++x)
                for (const Point& in_cell : cell.points) {
                    const std::array<long, 3> at{x, y, z};
                    Point point{};
                    for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a)
                        point[a] = origin[a] + (static_cast<double>(at[a]) + in_cell[a]) * edges[a];
                    if (is_box || contains(shape, point, dimension)) visit(point);
                }
}

}  // namespace talus
