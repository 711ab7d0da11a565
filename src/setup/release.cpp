#include "src/setup/release.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "physics/depth/kernel.hpp"
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
    bool is_wet(const Point& place) const {
        if (!release_.area.rings.empty()) return release_.area.contains(place[0], place[1]);
        return contains(release_.shape, place, dimension_);
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
    /// Depths within the bounds are known from the first use on.
    double depth_at(const Site& site) const {
        if (site[0] < 0 || site[1] < 0 || site[0] >= count_[0] || site[1] >= count_[1])
            return depth(place(site));
        if (depths_.empty()) depths_.assign(static_cast<std::size_t>(count_[0] * count_[1]), -1);
        double& known = depths_[static_cast<std::size_t>(site[1] * count_[0] + site[0])];
        if (known < 0) known = depth(place(site));
        return known;
    }
    double volume(const Point& place, double depth) const {
        if (settings_.form == depth::Form::cartesian) return depth * area_;
        return depth * area_ / depth::Tilt(terrain_.slope(place[0], place[1])).cosine;
    }
    double smoothing_length() const { return settings_.eta * std::pow(area_, 1.0 / dimension_); }

    struct Sums {
        double number, dilation, height;  ///< sum W, sum r dW/dr [1/m^D]; sum V W [m]
    };
    /// At a site, of the columns all around that are deeper than `least_depth`.
    template <int D>
    Sums sums(const Site& site, double smoothing_length, double least_depth) const {
        const depth::Kernel<D> kernel;
        const double range = depth::Settings::support() * smoothing_length;
        const long x_range = static_cast<long>(range / spacing_[0]),
                   y_range = D == 2 ? static_cast<long>(range / spacing_[1]) : 0;
        const double factor = depth::lattice_factor<D>(settings_);
        Sums sums{};
        for (long y = -y_range; y <= y_range; ++y)
            for (long x = -x_range; x <= x_range; ++x) {
                const Site other_site{site[0] + x, site[1] + y};
                const Point other = place(other_site);
                const double there = depth_at(other_site);
                if (!(there > least_depth)) continue;
                const Point r = minus(other, place(site));
                const double r2 = dot(r, r), value = factor * kernel.value(r2, 1 / smoothing_length);
                sums.number += value;
                sums.dilation += factor * kernel.factor(r2, 1 / smoothing_length) * r2;
                sums.height += area_ * there * value;
            }
        return sums;
    }

  private:
    const Release& release_;
    const Terrain& terrain_;
    const depth::Settings& settings_;
    int dimension_;
    Site count_{1, 1};
    std::array<double, 2> spacing_{}, origin_{};
    double area_;
    mutable std::vector<double> depths_;
};

/// Solves sum W(r, s) = (eta/s)^D at a site, whose left side times s^D grows with s, and sets the column's
/// smoothing length and correction by it: Newton's steps for the logarithm of s, kept between bounds.
template <int D>
void find_correction(const Lattice& lattice, const Lattice::Site& site, const depth::Settings& settings,
                     double least_depth, ReleasedColumn& column) {
    constexpr int most_rounds = 200;
    double s = column.smoothing_length, least = 0, most = settings.largest_smoothing_length;
    typename Lattice::Sums sums{};
    for (int round = 0; round < most_rounds; ++round) {
        sums = lattice.sums<D>(site, s, least_depth);
        const double over = std::log(sums.number) + D * std::log(s / settings.eta);
        (over > 0 ? most : least) = s;
        double next = s * std::exp(over * sums.number / sums.dilation);
        if (!(next > least && next < most)) next = 0.5 * (least + most);
        const bool found = std::abs(next / s - 1) < 2e-16;
        s = next;
        if (found) break;
    }
    column.smoothing_length = s;
    column.correction = column.depth / lattice.sums<D>(site, s, least_depth).height;
}

}  // namespace

std::vector<ReleasedColumn> columns_of(const Release& release, const Terrain& terrain,
                                       const depth::Settings& settings, int dimension,
                                       std::optional<Point>& unknown) {
    constexpr double least_share = 1e-3;
    const Lattice lattice(release, terrain, settings, dimension);
    std::vector<ReleasedColumn> columns;
    std::vector<Lattice::Site> sites;
    double greatest = 0;
    for (long y = 0; y < lattice.count()[1]; ++y)
        for (long x = 0; x < lattice.count()[0]; ++x) {
            const Point place = lattice.place({x, y});
            if (!lattice.is_wet(place)) continue;
            if (!release.level && !unknown && !terrain.contains(place[0], place[1])) unknown = place;
            const double depth = lattice.depth(place);
            greatest = std::max(greatest, depth);
            columns.push_back({place, depth, lattice.volume(place, depth), lattice.smoothing_length(), 1});
            sites.push_back({x, y});
        }
    const double least_depth = least_share * greatest;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < columns.size(); ++k) {
        if (!(columns[k].depth > least_depth)) continue;
        columns[kept] = columns[k];
        if (settings.gradient == depth::Gradient::balanced) {
            if (dimension == 1)
                find_correction<1>(lattice, sites[k], settings, least_depth, columns[kept]);
            else
                find_correction<2>(lattice, sites[k], settings, least_depth, columns[kept]);
        }
        ++kept;
    }
    columns.resize(kept);
    return columns;
}

}  // namespace talus
