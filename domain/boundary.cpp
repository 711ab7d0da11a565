#include "domain/boundary.hpp"

#include <algorithm>
#include <cmath>

namespace talus {

double mirror_sign(Shape shape, int component, int dimension, const std::array<bool, 3>& flip) {
    const auto sign = [&flip](int axis) { return flip[static_cast<std::size_t>(axis)] ? -1.0 : 1.0; };
    switch (shape) {
        case Shape::scalar:
        case Shape::profile:
            return 1;
        case Shape::vector:
        case Shape::point:
            return sign(component);
        case Shape::symmetric_tensor: {
            const AxisPair axes = symmetric_axes(component, dimension);
            return sign(axes.first) * sign(axes.second);
        }
        case Shape::tensor:
            return sign(component / dimension) * sign(component % dimension);
    }
    return 1;
}

double wrapped(double coordinate, double lower, double upper) {
    if (coordinate >= lower && coordinate < upper) return coordinate;
    const double length = upper - lower;
    coordinate -= length * std::floor((coordinate - lower) / length);
    return coordinate < lower || coordinate >= upper ? lower : coordinate;  // rounding put it on the edge
}

namespace {

void mirror_state(ParticleSet& particles, std::size_t i, int axis) {
    std::array<bool, 3> flip{};
    flip[static_cast<std::size_t>(axis)] = true;
    for (Column& column : particles.columns()) {
        const FieldInfo& info = *column.info;
        if (info.role != Role::state || info.shape == Shape::scalar || info.shape == Shape::point) continue;
        for (std::size_t c = 0; c < column.components.size(); ++c)
            if (mirror_sign(info.shape, static_cast<int>(c), particles.dimension(), flip) < 0) {
                double& value = reinterpret_cast<double*>(column.components[c].data())[i];
                value = -value;
            }
    }
}

/// `carried`: coordinates of other points of the same particles.
void wrap_axis(std::span<double> x, double lower, double upper, std::span<double* const> carried) {
    for (std::size_t i = 0; i < x.size(); ++i) {
        double& coordinate = x[i];
        if (coordinate >= lower && coordinate < upper) continue;
        const double before = coordinate;
        coordinate = wrapped(coordinate, lower, upper);
        for (double* other : carried) other[i] += coordinate - before;
    }
}

/// Coordinates of the points of a particle's state besides its position.
std::vector<double*> other_points(ParticleSet& particles, std::size_t axis) {
    std::vector<double*> points;
    for (Column& column : particles.columns())
        if (column.info->role == Role::state && column.info->shape == Shape::point &&
            column.info != &field::position)
            points.push_back(reinterpret_cast<double*>(column.components[axis].data()));
    return points;
}

/// Brings a coordinate back between two walls; true if it was mirrored an odd number of times.
bool reflect(double& x, double lower, double upper) {
    if (x >= lower && x <= upper) return false;
    const double mirrored = 2 * (x < lower ? lower : upper) - x;
    if (mirrored >= lower && mirrored <= upper) {
        x = mirrored;
        return true;
    }
    const double length = upper - lower;  // further out than the box is long
    double beyond = std::fmod(x - lower, 2 * length);
    if (beyond < 0) beyond += 2 * length;
    const bool odd = beyond > length;
    x = std::clamp(lower + (odd ? 2 * length - beyond : beyond), lower, upper);  // NaN stays NaN
    return odd;
}

}  // namespace

void apply_boundaries(ParticleSet& particles, const Box& box) {
    for (int axis = 0; axis < box.dimension; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        std::span<double> x = particles.own(field::position, axis);
        if (box.boundary[a] == Boundary::periodic) {
            wrap_axis(x, box.lower[a], box.upper[a], other_points(particles, a));
        } else if (box.boundary[a] == Boundary::reflecting) {
            for (std::size_t i = 0; i < x.size(); ++i)
                if (reflect(x[i], box.lower[a], box.upper[a])) mirror_state(particles, i, axis);
        }
    }
}

}  // namespace talus
