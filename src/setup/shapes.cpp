#include "src/setup/shapes.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

namespace talus {

namespace {

double ball_volume(double radius, int dimension) {
    using std::numbers::pi;
    if (dimension == 1) return 2 * radius;
    if (dimension == 2) return pi * radius * radius;
    return 4.0 / 3 * pi * radius * radius * radius;
}

/// Squared length in units of the semi-axes.
double scaled_length2(const Point& arm, const Point& semi_axes, int dimension) {
    double sum = 0;
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
        const double d = arm[a] / semi_axes[a];
        sum += d * d;
    }
    return sum;
}

struct Contains {
    const Point& point;
    int dimension;

    bool operator()(const BoxShape& box) const {
        for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a)
            if (point[a] < box.lower[a] || point[a] >= box.upper[a]) return false;
        return true;
    }
    bool operator()(const SphereShape& sphere) const {
        const double distance2 = scaled_length2(minus(point, sphere.centre), {1, 1, 1}, dimension);
        return distance2 < sphere.radius * sphere.radius &&
               distance2 >= sphere.inner_radius * sphere.inner_radius;
    }
    bool operator()(const EllipsoidShape& ellipsoid) const {
        const Point arm = ellipsoid.orientation.inverse(minus(point, ellipsoid.centre));
        return scaled_length2(arm, ellipsoid.semi_axes, dimension) < 1;
    }
    bool operator()(const MeshShape& mesh) const {
        return mesh.surface->winding_number(minus(point, mesh.centre)) > 0;
    }
};

struct Volume {
    int dimension;

    double operator()(const BoxShape& box) const {
        double product = 1;
        for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a)
            product *= box.upper[a] - box.lower[a];
        return product;
    }
    double operator()(const SphereShape& sphere) const {
        return ball_volume(sphere.radius, dimension) - ball_volume(sphere.inner_radius, dimension);
    }
    double operator()(const EllipsoidShape& ellipsoid) const {
        double product = ball_volume(1, dimension);
        for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a)
            product *= ellipsoid.semi_axes[a];
        return product;
    }
    double operator()(const MeshShape& mesh) const { return mesh.surface->integrals().volume; }
};

struct Bounds {
    int dimension;

    BoxShape operator()(const BoxShape& box) const { return box; }
    BoxShape operator()(const SphereShape& sphere) const {
        return around(sphere.centre, {sphere.radius, sphere.radius, sphere.radius});
    }
    BoxShape operator()(const EllipsoidShape& ellipsoid) const {
        Point extent{};
        for (std::size_t a = 0; a < 3; ++a) {
            double sum = 0;
            for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) {
                const double part = ellipsoid.orientation.rows[a][k] * ellipsoid.semi_axes[k];
                sum += part * part;
            }
            extent[a] = std::sqrt(sum);
        }
        return around(ellipsoid.centre, extent);
    }
    BoxShape operator()(const MeshShape& mesh) const {
        return {plus(mesh.centre, mesh.surface->lower()), plus(mesh.centre, mesh.surface->upper())};
    }

  private:
    BoxShape around(const Point& middle, const Point& extent) const {
        BoxShape box{middle, middle};
        for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
            box.lower[a] -= extent[a];
            box.upper[a] += extent[a];
        }
        return box;
    }
};

struct Centre {
    Point operator()(const BoxShape& box) const { return times(0.5, plus(box.lower, box.upper)); }
    template <class Round>
    Point operator()(const Round& shape) const {
        return shape.centre;
    }
};

struct Move {
    const Point& by;

    void operator()(BoxShape& box) const {
        box.lower = plus(box.lower, by);
        box.upper = plus(box.upper, by);
    }
    template <class Round>
    void operator()(Round& shape) const {
        shape.centre = plus(shape.centre, by);
    }
};

}  // namespace

bool contains(const BodyShape& shape, const Point& point, int dimension) {
    return std::visit(Contains{point, dimension}, shape);
}

double volume(const BodyShape& shape, int dimension) { return std::visit(Volume{dimension}, shape); }

BoxShape bounds(const BodyShape& shape, int dimension) { return std::visit(Bounds{dimension}, shape); }

double thickness(const BodyShape& shape, int dimension) {
    const BoxShape around = bounds(shape, dimension);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a)
        least = std::min(least, around.upper[a] - around.lower[a]);
    return least;
}

Point centre(const BodyShape& shape) { return std::visit(Centre{}, shape); }

BodyShape moved(const BodyShape& shape, const Point& by) {
    BodyShape result = shape;
    std::visit(Move{by}, result);
    return result;
}

}  // namespace talus
