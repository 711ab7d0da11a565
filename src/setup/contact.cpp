#include "src/setup/contact.hpp"

#include <algorithm>
#include <limits>

namespace talus {

namespace {

/// Where a line meets a shape, first and last.
struct Span {
    double from = std::numeric_limits<double>::infinity(), to = -from;

    void include(double x) {
        from = std::min(from, x);
        to = std::max(to, x);
    }
    bool empty() const { return from > to; }
};

/// A shape around the origin, seen along the x axis of a frame.
class Silhouette {
  public:
    /// `frame`: from the axes of the silhouette to those of space.
    Silhouette(const BodyShape& shape, const Rotation& frame, int dimension)
        : shape_(shape), frame_(frame), dimension_(static_cast<std::size_t>(dimension)) {
        if (const auto* mesh = std::get_if<MeshShape>(&shape)) {
            Polyhedron turned = mesh->surface->polyhedron();
            for (Point& vertex : turned.vertices) vertex = frame.inverse(vertex);
            turned_ = std::make_unique<SurfaceMesh>(std::move(turned));
        }
        const BoxShape around = bounds(shape, dimension);
        const Point middle = centre(shape);
        extent_ = norm(minus(around.upper, middle));
        extent_ = std::max(extent_, norm(minus(around.lower, middle)));
    }

    /// Nothing of the shape is farther from its centre.
    double extent() const { return extent_; }

    /// The part of the line along x through (y, z) that lies in the shape.
    Span at(double y, double z) const {
        if (turned_) return through_mesh(y, z);
        const Point start = frame_({0, y, z}), along = frame_({1, 0, 0});
        if (const auto* box = std::get_if<BoxShape>(&shape_)) return through_box(*box, start, along);
        if (const auto* sphere = std::get_if<SphereShape>(&shape_))
            return through_ellipsoid(start, along, {sphere->radius, sphere->radius, sphere->radius});
        const auto& ellipsoid = std::get<EllipsoidShape>(shape_);
        return through_ellipsoid(ellipsoid.orientation.inverse(start), ellipsoid.orientation.inverse(along),
                                 ellipsoid.semi_axes);
    }

  private:
    Span through_mesh(double y, double z) const {
        std::vector<SurfaceMesh::Crossing> crossings;
        turned_->crossings(y, z, crossings);
        Span span;
        for (const SurfaceMesh::Crossing& crossing : crossings) span.include(crossing.x);
        return span;
    }

    Span through_ellipsoid(const Point& start, const Point& along, const Point& semi_axes) const {
        double a = 0, b = 0, c = -1;  // a x^2 + 2 b x + c = 0 on the surface
        for (std::size_t k = 0; k < dimension_; ++k) {
            const double p = start[k] / semi_axes[k], q = along[k] / semi_axes[k];
            a += q * q;
            b += p * q;
            c += p * p;
        }
        Span span;
        if (const double root2 = b * b - a * c; root2 >= 0) {
            span.include((-b - std::sqrt(root2)) / a);
            span.include((-b + std::sqrt(root2)) / a);
        }
        return span;
    }

    Span through_box(const BoxShape& box, const Point& start, const Point& along) const {
        Span span{-extent_, extent_};
        for (std::size_t k = 0; k < dimension_; ++k) {
            const double half = 0.5 * (box.upper[k] - box.lower[k]);
            if (along[k] == 0) {
                if (std::abs(start[k]) > half) return {};
                continue;
            }
            const auto [from, to] =
                std::minmax({(-half - start[k]) / along[k], (half - start[k]) / along[k]});
            span.from = std::max(span.from, from);
            span.to = std::min(span.to, to);
        }
        return span;
    }

    const BodyShape& shape_;
    Rotation frame_;
    std::size_t dimension_;
    double extent_ = 0;
    std::unique_ptr<SurfaceMesh> turned_;
};

/// A frame whose x axis is `direction`; in 2D its z axis is that of space.
Rotation frame_along(const Point& direction) {
    const Point least = std::abs(direction[2]) < 0.9 ? Point{0, 0, 1} : Point{0, 1, 0};
    const Point across = cross(least, direction);
    const Point second = times(1 / norm(across), across), third = cross(direction, second);
    Rotation frame;
    for (std::size_t a = 0; a < 3; ++a) frame.rows[a] = {direction[a], second[a], third[a]};
    return frame;
}

}  // namespace

std::optional<double> contact_distance(const BodyShape& first, const BodyShape& second,
                                       const Point& direction, const Point& aside, int dimension) {
    const auto* ball = std::get_if<SphereShape>(&first);
    const auto* other = std::get_if<SphereShape>(&second);
    if (ball && other) {
        const double reach = ball->radius + other->radius, left = reach * reach - dot(aside, aside);
        if (left < 0) return {};
        return std::sqrt(left);
    }
    const Rotation frame = frame_along(direction);
    const Silhouette front(first, frame, dimension), back(second, frame, dimension);
    const Point shift = frame.inverse(aside);
    double best = -std::numeric_limits<double>::infinity();
    // Looks at lines across a square around (y, z), in the frame of the smaller shape.
    const bool small_first = front.extent() < back.extent();
    Point at = small_first ? Point{} : shift;
    const auto look = [&](double half_width, int lines_each_side) {
        const Point middle = at;
        const int lines_in_z = dimension == 3 ? lines_each_side : 0,
                  lines_in_y = dimension >= 2 ? lines_each_side : 0;
        for (int k = -lines_in_z; k <= lines_in_z; ++k)
            for (int j = -lines_in_y; j <= lines_in_y; ++j) {
                const double y = middle[1] + half_width * j / lines_each_side,
                             z = middle[2] + half_width * k / lines_each_side;
                const Span a = front.at(y, z), b = back.at(y - shift[1], z - shift[2]);
                if (a.empty() || b.empty() || !(a.to - b.from > best)) continue;
                best = a.to - b.from;
                at = {0, y, z};
            }
    };
    constexpr int lines = 50;
    double width = std::min(front.extent(), back.extent());
    look(width, lines);
    for (width *= 2.0 / lines; width > 1e-8 * front.extent(); width *= 0.5) look(width, 2);
    if (std::isinf(best)) return {};
    return best;
}

}  // namespace talus
