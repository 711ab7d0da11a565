#include "src/setup/release.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "physics/depth/motion.hpp"

namespace talus {

namespace {

/// Square of the distance from the middle over that of the edge, in its direction.
double relative_distance2(const BodyShape& shape, const Point& place, int dimension) {
    const Point from_middle = minus(place, centre(shape));
    if (const auto* ball = std::get_if<SphereShape>(&shape))
        return dot(from_middle, from_middle) / (ball->radius * ball->radius);
    const auto& ellipsoid = std::get<EllipsoidShape>(shape);
    const Point along = ellipsoid.orientation.inverse(from_middle);
    double sum = 0;
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a)
        sum += along[a] * along[a] / (ellipsoid.semi_axes[a] * ellipsoid.semi_axes[a]);
    return sum;
}

BoxShape bounds_of(const Release& release, int dimension) {
    if (release.area.rings.empty()) return bounds(release.shape, dimension);
    const std::array<double, 2> lower = release.area.lower(), upper = release.area.upper();
    return {{lower[0], lower[1], 0}, {upper[0], upper[1], 0}};
}

double depth_in(const TerrainGrid& raster, const Point& place) {
    const long column = std::lround((place[0] - raster.origin[0]) / raster.spacing[0]),
               row = std::lround((place[1] - raster.origin[1]) / raster.spacing[1]);
    if (column < 0 || row < 0 || column >= static_cast<long>(raster.columns) ||
        row >= static_cast<long>(raster.rows))
        return 0;
    const double depth = raster.at(static_cast<std::size_t>(column), static_cast<std::size_t>(row));
    return depth > 0 ? depth : 0;  // NaN too
}

class Lattice {
  public:
    Lattice(const Release& release, const Terrain& terrain, const depth::Settings& settings, int dimension)
        : release_(release), terrain_(terrain), settings_(settings), dimension_(dimension) {
        const BoxShape around = bounds_of(release, dimension);
        for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
            const double length = around.upper[a] - around.lower[a];
            count_[a] = std::max(1L, std::lround(length / release.spacing));
            spacing_[a] = length / static_cast<double>(count_[a]);
            origin_[a] = around.lower[a] + 0.5 * spacing_[a];
        }
        area_ = spacing_[0] * (dimension == 2 ? spacing_[1] : 1);
    }

    using Site = std::array<long, 2>;
    const Site& count() const { return count_; }
    bool contains(const Point& place) const {
        if (!release_.area.rings.empty()) return release_.area.contains(place[0], place[1]);
        return talus::contains(release_.shape, place, dimension_);
    }
    Point place(const Site& site) const {
        Point place{};
        for (std::size_t a = 0; a < static_cast<std::size_t>(dimension_); ++a)
            place[a] = origin_[a] + static_cast<double>(site[a]) * spacing_[a];
        return place;
    }
    /// Depth of the release if it went on beyond the edge of its region [m].
    double depth(const Point& place) const {
        if (release_.level) {
            const double ground = terrain_.elevation(place[0], place[1]);
            return *release_.level > ground ? *release_.level - ground : 0;
        }
        if (release_.depth_raster) return depth_in(*release_.depth_raster, place);
        if (!release_.parabolic) return release_.depth;
        return release_.depth * std::max(0.0, 1 - relative_distance2(release_.shape, place, dimension_));
    }
    double volume(const Point& place, double depth) const {
        if (settings_.form == depth::Form::cartesian) return depth * area_;
        return depth * area_ / depth::Tilt(terrain_.slope(place[0], place[1])).cosine;
    }
    double smoothing_length() const { return settings_.eta * std::pow(area_, 1.0 / dimension_); }

  private:
    const Release& release_;
    const Terrain& terrain_;
    const depth::Settings& settings_;
    int dimension_;
    Site count_{1, 1};
    std::array<double, 2> spacing_{}, origin_{};
    double area_;
};

/// Whether the terrain is not known at one of the four sites around.
bool is_at_rim(const Lattice& lattice, const Terrain& terrain, const Lattice::Site& site, int dimension) {
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a)
        for (const long step : {-1L, 1L}) {
            Lattice::Site beside = site;
            beside[a] += step;
            const Point place = lattice.place(beside);
            if (lattice.contains(place) && !terrain.contains(place[0], place[1])) return true;
        }
    return false;
}

/// Sites beyond the bounds that a release goes on in: what reaches the particles at its edge, and what
/// reaches that.
constexpr long margin = 8;

bool is_in(const Box& box, const Point& place) {
    for (std::size_t a = 0; a < static_cast<std::size_t>(box.dimension); ++a)
        if (box.boundary[a] != Boundary::open && (place[a] < box.lower[a] || place[a] > box.upper[a]))
            return false;
    return true;
}

}  // namespace

ReleasedColumns columns_of(const Release& release, const Terrain& terrain, const depth::Settings& settings,
                           const Box& box) {
    constexpr double least_share = 1e-3;
    const Lattice lattice(release, terrain, settings, box.dimension);
    const bool goes_on = settings.balance && release.level;
    const long beyond = goes_on ? margin : 0, beyond_y = box.dimension == 2 ? beyond : 0;
    ReleasedColumns columns;
    double greatest = 0;
    for (long y = -beyond_y; y < lattice.count()[1] + beyond_y; ++y)
        for (long x = -beyond; x < lattice.count()[0] + beyond; ++x) {
            const Point place = lattice.place({x, y});
            const bool is_released = lattice.contains(place);
            if (!is_released && !(goes_on && is_in(box, place))) continue;
            const double depth = lattice.depth(place);
            if (!release.level && !columns.unknown && depth > 0 && !terrain.contains(place[0], place[1]))
                columns.unknown = place;
            if (release.level && !columns.cut && is_released && depth > 0 &&
                is_at_rim(lattice, terrain, {x, y}, box.dimension))
                columns.cut = place;
            if (!columns.outside_box && depth > 0 && !is_in(box, place)) columns.outside_box = place;
            const ReleasedColumn column{place, depth, lattice.volume(place, depth),
                                        lattice.smoothing_length()};
            (is_released ? columns.released : columns.beyond).push_back(column);
            if (is_released) greatest = std::max(greatest, depth);
        }
    const auto is_dry = [&](const ReleasedColumn& column) {
        return !(column.depth > least_share * greatest);
    };
    std::erase_if(columns.released, is_dry);
    std::erase_if(columns.beyond, is_dry);
    return columns;
}

}  // namespace talus
