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

class Lattice {
  public:
    Lattice(const Release& release, const Terrain& terrain, const depth::Settings& settings, int dimension)
        : release_(release), terrain_(terrain), settings_(settings), dimension_(dimension) {
        const BoxShape around = bounds(release.shape, dimension);
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
    bool is_wet(const Point& place) const { return contains(release_.shape, place, dimension_); }
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
        if (!release_.parabolic) return release_.depth;
        return release_.depth * std::max(0.0, 1 - relative_distance2(release_.shape, place, dimension_));
    }
    double volume(const Point& place, double depth) const {
        if (settings_.form == depth::Form::cartesian) return depth * area_;
        return depth * area_ / depth::Tilt(terrain_.slope(place[0], place[1])).cosine;
    }
    double smoothing_length() const { return settings_.eta * std::pow(area_, 1.0 / dimension_); }

    /// The kernel sum at a site, of columns all around.
    template <int D>
    double height(const Site& site, double smoothing_length) const {
        const depth::Kernel<D> kernel;
        const double range = depth::Settings::support() * smoothing_length;
        const long x_range = static_cast<long>(range / spacing_[0]),
                   y_range = D == 2 ? static_cast<long>(range / spacing_[1]) : 0;
        double sum = 0;
        for (long y = -y_range; y <= y_range; ++y)
            for (long x = -x_range; x <= x_range; ++x) {
                const Point other = place({site[0] + x, site[1] + y});
                const Point r = minus(other, place(site));
                sum += area_ * depth(other) * kernel.value(dot(r, r), 1 / smoothing_length);
            }
        return depth::lattice_factor<D>(settings_) * sum;
    }

  private:
    const Release& release_;
    const Terrain& terrain_;
    const depth::Settings& settings_;
    int dimension_;
    Site count_{1, 1};
    std::array<double, 2> spacing_{}, origin_{};
    double area_;
};

/// Solves s = eta (V/H(s))^(1/D) at a site, and sets the column's smoothing length and correction by it.
template <int D>
void find_correction(const Lattice& lattice, const Lattice::Site& site, double eta, ReleasedColumn& column) {
    constexpr int most_rounds = 100;
    double s = column.smoothing_length, height = 0;
    for (int round = 0; round < most_rounds; ++round) {
        height = lattice.height<D>(site, s);
        const double next = 0.5 * (s + eta * std::pow(column.volume / height, 1.0 / D));
        const bool found = std::abs(next / s - 1) < 1e-15;
        s = next;
        if (found) break;
    }
    column.smoothing_length = s;
    column.correction = column.depth / height;
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
    std::size_t kept = 0;
    for (std::size_t k = 0; k < columns.size(); ++k) {
        if (!(columns[k].depth > least_share * greatest)) continue;
        columns[kept] = columns[k];
        if (settings.gradient == depth::Gradient::balanced) {
            if (dimension == 1)
                find_correction<1>(lattice, sites[k], settings.eta, columns[kept]);
            else
                find_correction<2>(lattice, sites[k], settings.eta, columns[kept]);
        }
        ++kept;
    }
    columns.resize(kept);
    return columns;
}

}  // namespace talus
