#pragma once
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "physics/dem/vector3.hpp"

namespace talus::coupling {

/// Weight w(r) with which a grain is spread over the fluid within `radius`, of integral 1. The mollifier
/// C/R^D exp(1/(r^2/R^2 - 1)) is smooth in all derivatives.
template <int D>
class Mollifier {
  public:
    explicit Mollifier(double radius)
        : inverse2_(1 / (radius * radius)), scale_(constant / std::pow(radius, D)) {}
    double operator()(double r2) const {
        const double x = r2 * inverse2_;
        return x < 1 ? scale_ * std::exp(1 / (x - 1)) : 0.0;
    }
    /// Of the integral 1 for the radius 1: found by quadrature to all digits.
    static constexpr double constant = D == 1   ? 2.252283621043581
                                       : D == 2 ? 2.1435657757922366
                                                : 2.2671167396083265;

  private:
    double inverse2_, scale_;
};

/// Wendland's C2 function over the same radius: cheaper, no exponential. H. Wendland, Adv. Comput. Math. 4
/// (1995) 389.
class WendlandWeight {
  public:
    explicit WendlandWeight(double radius)
        : inverse_(1 / radius), scale_(21 / (2 * std::numbers::pi * radius * radius * radius)) {}
    double operator()(double r2) const {
        const double q = std::sqrt(r2) * inverse_;
        if (q >= 1) return 0;
        const double x = (1 - q) * (1 - q);
        return scale_ * x * x * (1 + 4 * q);
    }

  private:
    double inverse_, scale_;
};

/// A flat wall: grains near it are spread as if they had a mirror image behind it, so that nothing of them is
/// lost.
struct MirrorPlane {
    dem::Vector3<> point, normal;  ///< unit vector into the fluid
};

/// A place and its images in the planes that are nearer than `radius`, those in two or three planes after
/// another included: exact for planes at right angles.
inline void list_images(const dem::Vector3<>& place, std::span<const MirrorPlane> planes, double radius,
                        std::vector<dem::Vector3<>>& images) {
    images.assign(1, place);
    for (const MirrorPlane& plane : planes) {
        const double height = dot(place - plane.point, plane.normal);
        if (!(std::abs(height) < radius)) continue;
        const std::size_t count = images.size();
        for (std::size_t k = 0; k < count; ++k)
            images.push_back(images[k] - 2 * dot(images[k] - plane.point, plane.normal) * plane.normal);
    }
}

}  // namespace talus::coupling
