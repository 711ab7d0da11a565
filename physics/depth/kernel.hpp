#pragma once
#include "physics/depth/settings.hpp"
#include "physics/sph/kernels.hpp"

namespace talus::depth {

template <int D>
using Kernel = sph::WendlandC2<D>;

/// Factor that makes the kernel's sum over an even lattice of squares exact: an even layer has the depth that
/// it was released with.
template <int D>
double lattice_factor(const Settings& settings) {
    const Kernel<D> kernel;
    const int range = static_cast<int>(Settings::support() * settings.eta);
    double sum = 0;
    for (int y = D == 2 ? -range : 0; y <= (D == 2 ? range : 0); ++y)
        for (int x = -range; x <= range; ++x)
            sum += kernel.value(static_cast<double>(x * x + y * y), 1 / settings.eta);
    return 1 / sum;
}

/// Area in plan that a column of this smoothing length stands for, its square of the lattice; length in 1D.
template <int D, class Real>
Real area_of(const Real& smoothing_length, double eta) {
    const Real side = smoothing_length / eta;
    return D == 1 ? side : side * side;
}

/// Cover of the other phase from which on a column is within it and not at its edge.
inline constexpr double full_cover = 0.5;

}  // namespace talus::depth
