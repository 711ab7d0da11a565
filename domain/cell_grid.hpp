#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "domain/box.hpp"

namespace talus {

/// Integer coordinates of a cell of the global grid; axes beyond the dimension stay 0.
using Cell = std::array<int, 3>;

/// A cell as one number, ordered by z, then y, then x: cells along x are neighbours in the order.
using CellKey = std::uint64_t;

/// Coordinates run from -cell_limit to cell_limit; positions further out along open axes are counted to
/// the outermost cell.
inline constexpr int cell_limit = (1 << 20) - 64;

constexpr CellKey key_of(const Cell& cell) {
    constexpr std::int64_t bias = 1 << 20;
    return static_cast<CellKey>((cell[2] + bias) << 42 | (cell[1] + bias) << 21 | (cell[0] + bias));
}
constexpr Cell cell_of(CellKey key) {
    constexpr int bias = 1 << 20, mask = (1 << 21) - 1;
    return {static_cast<int>(key & mask) - bias, static_cast<int>(key >> 21 & mask) - bias,
            static_cast<int>(key >> 42 & mask) - bias};
}

/// How a copy of a cell's particles is placed beyond a periodic or reflecting boundary.
struct Image {
    Cell cell{};                    ///< where the copy stands, in grid coordinates beyond the box
    std::array<double, 3> shift{};  ///< added to positions after flipping [m]
    std::array<bool, 3> flip{};     ///< axes along which position and vectors change sign

    bool is_original() const;
};

/// The global grid of cubic cells, sparse and unbounded along open axes. Its size follows from the
/// interaction radius alone, never from history, so that every run and restart has the same grid.
class CellGrid {
  public:
    /// `radius`: largest interaction radius [m]; cells are at least radius / reach wide, and along closed
    /// axes a whole number of them fits the box. Throws std::invalid_argument if a closed axis of the box
    /// is shorter than the radius. In a sheared box cells are twice as wide along x, for images across y to
    /// be counted to the nearest cell, and the box twice as long at least.
    CellGrid(const Box& box, double radius, int reach);

    /// The same cells for another radius: as many of them are reached as that takes.
    CellGrid reaching(double radius) const;

    const Box& box() const { return box_; }
    /// How many cells away an interaction partner can be.
    int reach() const { return reach_; }
    double cell_size(int axis) const { return size_[static_cast<std::size_t>(axis)]; }
    /// Largest radius that this grid's cells cover [m].
    double covered_radius() const { return covered_radius_; }
    /// Number of cells along a closed axis, 0 along an open one.
    int cell_count(int axis) const { return count_[static_cast<std::size_t>(axis)]; }

    /// Coordinate along one axis counted in cells, not limited to the outermost ones.
    double in_cells(int axis, double coordinate) const {
        const auto a = static_cast<std::size_t>(axis);
        return (coordinate - origin_[a]) * inverse_size_[a];
    }
    /// Cell index of a coordinate along one axis.
    int index_along(int axis, double coordinate) const {
        const auto a = static_cast<std::size_t>(axis);
        const double index = in_cells(axis, coordinate);
        const int lowest = count_[a] > 0 ? 0 : -cell_limit;
        const int highest = count_[a] > 0 ? count_[a] - 1 : cell_limit;
        if (!(index > lowest)) return lowest;
        if (index >= highest) return highest;
        const int truncated = static_cast<int>(index);
        return truncated - (index < truncated ? 1 : 0);
    }

    /// Moves the images across y along x, the upper ones by `offset` [m]; boxes with a shear rate only.
    void displace_images(double offset) { image_offset_ = offset; }

    /// All copies of a cell within `reach` of the box, the original first.
    std::vector<Image> images(const Cell& cell) const;
    /// Whether images() gives more than the original.
    bool has_copies(const Cell& cell) const;

    /// The grid for a radius that varies from step to step: the smallest of a ladder of radii (ratio
    /// 2^(1/8)) that is not below it, so that small changes leave the grid alone.
    static double ladder_radius(double radius);

  private:
    std::vector<Image> sheared_images(const Cell& cell) const;

    Box box_;
    int reach_;
    double image_offset_ = 0;
    double covered_radius_;
    std::array<double, 3> origin_{}, size_{}, inverse_size_{};
    std::array<int, 3> count_{};
};

}  // namespace talus
