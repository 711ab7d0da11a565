#include "physics/soil/hencky.hpp"

#include <cmath>

namespace talus::soil {

namespace {

Eigen::Matrix3d matrix_of(const Tensor& t) {
    return Eigen::Matrix3d{{t[0], t[3], t[4]}, {t[3], t[1], t[5]}, {t[4], t[5], t[2]}};
}

Tensor tensor_of(const Eigen::Matrix3d& m) { return {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)}; }

/// g(m) of a symmetric matrix.
template <class Function>
Eigen::Matrix3d spectral(const Eigen::Matrix3d& m, Function&& g) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(m);
    const Eigen::Vector3d values = solver.eigenvalues().unaryExpr(g);
    return solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
}

/// The same where z is a principal axis, of the other two: g(m) = middle + slope (m - mean).
template <class Function>
Eigen::Matrix3d spectral_in_plane(const Eigen::Matrix3d& m, Function&& g) {
    const double mean = 0.5 * (m(0, 0) + m(1, 1)), half = 0.5 * (m(0, 0) - m(1, 1)), across = m(0, 1);
    const double radius = std::sqrt(half * half + across * across);
    const double upper = g(mean + radius), lower = g(mean - radius), middle = 0.5 * (upper + lower);
    const double slope = radius > 0 ? 0.5 * (upper - lower) / radius : 0;
    Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
    result(0, 0) = middle + slope * half;
    result(1, 1) = middle - slope * half;
    result(0, 1) = result(1, 0) = slope * across;
    result(2, 2) = g(m(2, 2));
    return result;
}

/// Elastic strain of a stress.
Eigen::Matrix3d strain_of(const Elasticity& elasticity, const Tensor& stress) {
    const double mean = trace(stress) / 3;
    return matrix_of(deviator(stress)) / (2 * elasticity.shear_modulus()) +
           mean / (3 * elasticity.bulk_modulus()) * Eigen::Matrix3d::Identity();
}

}  // namespace

Tensor hencky_stress(const Elasticity& elasticity, const Tensor& stress, const Eigen::Matrix3d& f) {
    const auto stretch = [](double e) { return std::exp(2 * e); };
    const auto strain = [](double b) { return 0.5 * std::log(b); };
    const Eigen::Matrix3d before = strain_of(elasticity, stress);
    const bool in_plane =
        stress[4] == 0 && stress[5] == 0 && f(0, 2) == 0 && f(1, 2) == 0 && f(2, 0) == 0 && f(2, 1) == 0;
    const Eigen::Matrix3d b = in_plane ? spectral_in_plane(before, stretch) : spectral(before, stretch);
    const Eigen::Matrix3d turned = f * b * f.transpose();
    return elasticity.stress_of(
        tensor_of(in_plane ? spectral_in_plane(turned, strain) : spectral(turned, strain)));
}

}  // namespace talus::soil
