#include "src/setup/glass.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "domain/random.hpp"

namespace talus {

namespace {

constexpr double reach = 2.5;          // of the repulsion, in spacings
constexpr double skin = 0.6;           // by which listed pairs may be farther apart
constexpr double kept_velocity = 0.9;  // share left after a step
constexpr double step_length = 0.06;   // twice as much is still stable
constexpr int steps = 150;  // the density is even to 0.2 % then, and no more after ten times as many

/// A cubic periodic cell with one point per unit volume.
class PeriodicCell {
  public:
    PeriodicCell(int dimension, int edge, std::uint64_t seed)
        : dimension_(static_cast<std::size_t>(dimension)), edge_(edge) {
        const auto count = static_cast<std::size_t>(std::lround(std::pow(edge, dimension)));
        const RandomStream random{seed, RandomPurpose::glass, 0};
        points_.resize(count);
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t a = 0; a < dimension_; ++a)
                points_[i][a] = edge_ * random.uniform(i, static_cast<std::uint32_t>(a));
        velocities_.assign(count, Point{});
        list_pairs();
    }

    /// One step of damped motion.
    void relax() {
        std::vector<Point> forces(points_.size(), Point{});
        for (const auto& [i, j] : pairs_) {
            const Point apart = separation(i, j);
            const double r2 = dot(apart, apart);
            if (r2 >= reach * reach) continue;
            // Minus the slope of Wendland's C2 kernel: H. Wendland, Adv. Comput. Math. 4 (1995) 389.
            const double near = 1 - std::sqrt(r2) / reach;
            const Point force = times(20 / reach * near * near * near, apart);
            forces[i] = plus(forces[i], force);
            forces[j] = minus(forces[j], force);
        }
        double greatest = 0;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            velocities_[i] = plus(times(kept_velocity, velocities_[i]), times(step_length, forces[i]));
            points_[i] = plus(points_[i], velocities_[i]);
            greatest = std::max(greatest, norm(velocities_[i]));
        }
        moved_ += greatest;
        if (2 * moved_ > skin) list_pairs();
    }

    /// The points in units of the edge, in [0, 1).
    std::vector<Point> scaled_points() const {
        std::vector<Point> scaled(points_.size());
        for (std::size_t i = 0; i < points_.size(); ++i)
            for (std::size_t a = 0; a < dimension_; ++a)
                scaled[i][a] = points_[i][a] / edge_ - std::floor(points_[i][a] / edge_);
        return scaled;
    }

  private:
    Point separation(std::size_t i, std::size_t j) const {
        Point apart{};
        for (std::size_t a = 0; a < dimension_; ++a) {
            apart[a] = points_[i][a] - points_[j][a];
            apart[a] -= edge_ * std::rint(apart[a] / edge_);
        }
        return apart;
    }

    void list_pairs() {
        pairs_.clear();
        moved_ = 0;
        for (std::uint32_t i = 0; i < points_.size(); ++i)
            for (std::uint32_t j = i + 1; j < points_.size(); ++j) {
                const Point apart = separation(i, j);
                if (dot(apart, apart) < (reach + skin) * (reach + skin)) pairs_.emplace_back(i, j);
            }
    }

    std::size_t dimension_;
    double edge_, moved_ = 0;  // moved_: the farthest any point may have gone since pairs were listed
    std::vector<Point> points_, velocities_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_;
};

}  // namespace

UnitCell glass_cell(int dimension, std::uint64_t seed) {
    const int edge = dimension == 3 ? 12 : 32;
    PeriodicCell cell(dimension, edge, seed);
    for (int step = 0; step < steps; ++step) cell.relax();
    const auto length = static_cast<double>(edge);
    return {{length, length, length}, cell.scaled_points(), false};
}

}  // namespace talus
