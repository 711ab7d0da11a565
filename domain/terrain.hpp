#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace talus {

/// Heights on a regular grid of points, with the place of the first point. The cells of a raster are such
/// points: their centres.
struct TerrainGrid {
    std::array<double, 2> origin{};     ///< of the first point: least x, least y [m]
    std::array<double, 2> spacing{};    ///< of neighbouring points along x and y, positive [m]
    std::size_t columns = 0, rows = 0;  ///< number of points along x and y, at least 2 each
    /// [m]; along x first, rows in order of growing y; NaN where nothing is known.
    std::vector<double> elevations;

    double at(std::size_t column, std::size_t row) const { return elevations[row * columns + column]; }
};

/// The ground at one place: z and its derivatives.
struct TerrainPoint {
    double elevation;                 ///< z [m]
    std::array<double, 2> slope;      ///< dz/dx, dz/dy [1]
    std::array<double, 3> curvature;  ///< d2z/dx2, d2z/dy2, d2z/dxdy [1/m]
};

/// The ground that a flow moves over: a smooth surface z(x, y), from a plane or from a grid of points.
///
/// Between the points of a grid z is the cubic convolution of the 4 x 4 points around: it passes through the
/// points, its slope is continuous, its second derivatives jump at the lines through the points. Exact for
/// surfaces linear in x and y, and for quadratic ones where all 4 x 4 points are known.
/// R. G. Keys, IEEE Trans. Acoust. Speech Signal Process. 29 (1981) 1153, with a = -1/2.
///
/// The ground is known where the 2 x 2 points around are. Those of the 4 x 4 that are beyond the rim or not
/// known are extrapolated linearly from the known ones, one value each, so that the slope stays continuous.
class Terrain {
  public:
    /// Whether z is known at a place.
    enum class Place {
        known,
        hole,    ///< within the rim, next to a point that is not known
        outside  ///< beyond the outermost points
    };

    /// The plane z = elevation + slope[0] x + slope[1] y, without bounds.
    Terrain(double elevation, std::array<double, 2> slope);
    /// Throws std::invalid_argument if there are fewer than 2 x 2 points, their number is not that of the
    /// elevations, or a spacing is not positive.
    explicit Terrain(TerrainGrid grid);

    Place place(double x, double y) const;
    bool contains(double x, double y) const { return place(x, y) == Place::known; }

    /// z and its derivatives; NaN in holes and outside.
    TerrainPoint at(double x, double y) const;
    double elevation(double x, double y) const { return at(x, y).elevation; }
    std::array<double, 2> slope(double x, double y) const { return at(x, y).slope; }
    std::array<double, 3> curvature(double x, double y) const { return at(x, y).curvature; }

    bool is_plane() const { return rows_ == 0; }
    /// Corners of the rectangle between the outermost points; infinite for a plane [m].
    std::array<double, 2> lower() const { return lower_; }
    std::array<double, 2> upper() const { return upper_; }
    /// Least distance of neighbouring points; infinite for a plane [m].
    double resolution() const {
        return is_plane() ? std::numeric_limits<double>::infinity() : std::min(spacing_[0], spacing_[1]);
    }
    /// "column 3, row 17" of the cell that holds the place, for messages: counted from 1, rows from the
    /// greatest y as in files; "" for a plane or outside.
    std::string cell_name(double x, double y) const;

  private:
    void extrapolate();
    double& node(std::size_t column, std::size_t row) { return nodes_[row * (columns_ + 2) + column]; }

    double elevation_ = 0;
    std::array<double, 2> slope_{};
    std::array<double, 2> lower_, upper_;
    std::array<double, 2> spacing_{};
    std::size_t columns_ = 0, rows_ = 0;
    std::vector<double> nodes_;   // with a ring of extrapolated ones
    std::vector<bool> is_known_;  // of the cells between 2 x 2 points
};

}  // namespace talus
