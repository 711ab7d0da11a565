#pragma once
#include <array>
#include <cmath>
#include <cstddef>

namespace talus {

/// Position or vector; components beyond the dimension of the scene are zero.
using Point = std::array<double, 3>;

inline Point plus(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Point times(double factor, const Point& a) { return {factor * a[0], factor * a[1], factor * a[2]}; }
inline double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double norm(const Point& a) { return std::sqrt(dot(a, a)); }

/// Rotation of space: the images of the three axes are the columns.
struct Rotation {
    std::array<Point, 3> rows{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

    Point operator()(const Point& a) const { return {dot(rows[0], a), dot(rows[1], a), dot(rows[2], a)}; }
    Point inverse(const Point& a) const {
        return plus(times(a[0], rows[0]), plus(times(a[1], rows[1]), times(a[2], rows[2])));
    }
    /// First this one, then `next`.
    Rotation then(const Rotation& next) const {
        Rotation both;
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j)
                both.rows[i][j] = dot(next.rows[i], {rows[0][j], rows[1][j], rows[2][j]});
        return both;
    }
};

/// Turns by `angle` [rad], right-handed, about the axis 0, 1 or 2.
inline Rotation rotation_about(std::size_t axis, double angle) {
    const std::size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
    Rotation turn;
    turn.rows[b][b] = turn.rows[c][c] = std::cos(angle);
    turn.rows[c][b] = std::sin(angle);
    turn.rows[b][c] = -turn.rows[c][b];
    return turn;
}

}  // namespace talus
