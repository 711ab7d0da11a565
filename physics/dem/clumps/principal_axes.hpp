#pragma once
#include <Eigen/Eigenvalues>

namespace talus::dem {

/// Of a body in its centre of mass.
struct PrincipalAxes {
    Eigen::Vector3d moments;  ///< of inertia, of unit density
    Eigen::Matrix3d axes;     ///< right-handed, one a column
};

/// From the integrals of x_a x_b about the centre of mass.
inline PrincipalAxes principal_axes(const Eigen::Matrix3d& second_moments) {
    const Eigen::Matrix3d inertia = second_moments.trace() * Eigen::Matrix3d::Identity() - second_moments;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(inertia);
    Eigen::Matrix3d axes = solver.eigenvectors();
    if (axes.determinant() < 0) axes.col(2) = -axes.col(2);
    return {solver.eigenvalues(), axes};
}

}  // namespace talus::dem
