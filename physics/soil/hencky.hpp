#pragma once
#include <Eigen/Dense>

#include "physics/soil/constitutive.hpp"

namespace talus::soil {

/// Cauchy stress after an increment of the deformation gradient f within the elastic range: Hooke's law of
/// the logarithmic elastic strain e, b_e = exp(2 e) -> f b_e f^T (G. Weber, L. Anand, Comput. Methods Appl.
/// Mech. Eng. 79 (1990) 173). The stress itself tells e, so that nothing else is stored; it is what the
/// logarithmic rate of H. Xiao, O. T. Bruhns, A. Meyers, Acta Mech. 124 (1997) 89 integrates to: it turns
/// with rigid rotation, depends on the deformation alone and not on its path, and does not swing in large
/// shear as Jaumann's rate does. `f` in 2D: the identity along z.
Tensor hencky_stress(const Elasticity& elasticity, const Tensor& stress, const Eigen::Matrix3d& f);

}  // namespace talus::soil
