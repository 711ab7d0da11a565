#include "physics/dem/clumps/clump_shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "physics/dem/clumps/principal_axes.hpp"

namespace talus::dem {

namespace {

/// Integrals of 1, x and x x^T over a region [m3], [m4], [m5].
struct Moments {
    double volume = 0;
    Eigen::Vector3d first = Eigen::Vector3d::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
};

Eigen::Vector3d eigen(const Vector3<>& v) { return {v.x, v.y, v.z}; }

Moments of_separate_spheres(std::span<const Vector3<>> centres, std::span<const double> radii) {
    Moments sum;
    for (std::size_t k = 0; k < radii.size(); ++k) {
        const double r = radii[k], volume = 4.0 / 3.0 * std::numbers::pi * r * r * r;
        const Eigen::Vector3d centre = eigen(centres[k]);
        sum.volume += volume;
        sum.first += volume * centre;
        sum.second += volume * (centre * centre.transpose() + 0.2 * r * r * Eigen::Matrix3d::Identity());
    }
    return sum;
}

/// Lines along z through the middles of `lines` x `lines` squares.
Moments of_union(std::span<const Vector3<>> centres, std::span<const double> radii, int lines) {
    Eigen::Vector2d lower = Eigen::Vector2d::Constant(1e300), upper = -lower;
    for (std::size_t k = 0; k < radii.size(); ++k) {
        const Eigen::Vector2d centre(centres[k].x, centres[k].y);
        lower = lower.cwiseMin(centre - Eigen::Vector2d::Constant(radii[k]));
        upper = upper.cwiseMax(centre + Eigen::Vector2d::Constant(radii[k]));
    }
    const Eigen::Vector2d square = (upper - lower) / lines;
    struct Stretch {
        double begin, end;
    };
    std::vector<Stretch> inside;
    Moments sum;
    for (int i = 0; i < lines; ++i)
        for (int j = 0; j < lines; ++j) {
            const double x = lower.x() + (i + 0.5) * square.x(), y = lower.y() + (j + 0.5) * square.y();
            inside.clear();
            for (std::size_t k = 0; k < radii.size(); ++k) {
                const double dx = x - centres[k].x, dy = y - centres[k].y,
                             half2 = radii[k] * radii[k] - dx * dx - dy * dy;
                if (half2 <= 0) continue;
                const double half = std::sqrt(half2);
                inside.push_back({centres[k].z - half, centres[k].z + half});
            }
            std::sort(inside.begin(), inside.end(),
                      [](const Stretch& a, const Stretch& b) { return a.begin < b.begin; });
            double reached = -1e300;
            for (const Stretch& stretch : inside) {
                const double a = std::max(stretch.begin, reached), b = stretch.end;
                if (b <= a) continue;
                reached = b;
                const double length = b - a, z = (b * b - a * a) / 2, zz = (b * b * b - a * a * a) / 3;
                sum.volume += length;
                sum.first += Eigen::Vector3d(x * length, y * length, z);
                Eigen::Matrix3d second;
                second << x * x * length, x * y * length, x * z,  //
                    x * y * length, y * y * length, y * z,        //
                    x * z, y * z, zz;
                sum.second += second;
            }
        }
    const double area = square.x() * square.y();
    return {area * sum.volume, area * sum.first, area * sum.second};
}

bool overlap(std::span<const Vector3<>> centres, std::span<const double> radii) {
    for (std::size_t a = 0; a < radii.size(); ++a)
        for (std::size_t b = a + 1; b < radii.size(); ++b)
            if (norm(centres[a] - centres[b]) < (radii[a] + radii[b]) * (1 - 1e-12)) return true;
    return false;
}

/// Shares v (1 + a + b c), c the centres in units of `length`, v the volumes' shares: four equations for a
/// and b, of which fewer count if the centres lie in a plane or on a line.
std::vector<double> mass_shares(std::span<const Vector3<>> centres, std::span<const double> radii,
                                double length) {
    Eigen::Matrix4d sums = Eigen::Matrix4d::Zero();
    double volume = 0;
    for (const double r : radii) volume += r * r * r;
    std::vector<Eigen::Vector4d> places;
    for (std::size_t k = 0; k < radii.size(); ++k) {
        const Eigen::Vector3d c = eigen(centres[k]) / length;
        places.emplace_back(1, c.x(), c.y(), c.z());
        sums += std::pow(radii[k], 3) / volume * places[k] * places[k].transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(sums);
    Eigen::Vector4d factors = Eigen::Vector4d::Zero();
    for (int e = 0; e < 4; ++e)
        if (solver.eigenvalues()[e] > 1e-10)
            factors += solver.eigenvectors()(0, e) / solver.eigenvalues()[e] * solver.eigenvectors().col(e);
    std::vector<double> shares;
    for (std::size_t k = 0; k < radii.size(); ++k)
        shares.push_back(std::pow(radii[k], 3) / volume * factors.dot(places[k]));
    return shares;
}

}  // namespace

ClumpShape clump_shape(std::span<const Vector3<>> centres, std::span<const double> radii, int lines) {
    if (radii.empty() || centres.size() != radii.size())
        throw std::invalid_argument("a clump needs as many radii as centres, one at least");
    if (!std::ranges::all_of(radii, [](double r) { return r > 0; }))
        throw std::invalid_argument("radii of a clump must be above 0");
    const Moments all =
        overlap(centres, radii) ? of_union(centres, radii, lines) : of_separate_spheres(centres, radii);
    const Eigen::Vector3d middle = all.first / all.volume;
    const Eigen::Matrix3d about = all.second - all.volume * middle * middle.transpose();
    const auto [moments, axes] = principal_axes(about);
    ClumpShape shape{.centres = {},
                     .radii = {radii.begin(), radii.end()},
                     .volume = all.volume,
                     .inertia = {moments[0], moments[1], moments[2]},
                     .bounding_radius = 0,
                     .extent = 0,
                     .mass_shares = {}};
    for (std::size_t k = 0; k < radii.size(); ++k) {
        const Eigen::Vector3d place = axes.transpose() * (eigen(centres[k]) - middle);
        shape.centres.push_back({place.x(), place.y(), place.z()});
        shape.bounding_radius = std::max(shape.bounding_radius, place.norm() + radii[k]);
        for (const Vector3<>& other : shape.centres)
            shape.extent = std::max(shape.extent, norm(shape.centres.back() - other));
    }
    shape.mass_shares = mass_shares(shape.centres, radii, shape.bounding_radius);
    return shape;
}

}  // namespace talus::dem
