#pragma once
#include <array>
#include <cmath>

#include "physics/sph/small_tensors.hpp"

namespace talus {

/// Rotation by the angle that the spin (skew part of the velocity gradient, row by row [1/s]) turns in `time`
/// [s]: the exact exponential, so that rigid spin never changes the invariants of a rotated stress.
template <int D>
std::array<double, D * D> rotation(const std::array<double, D * D>& velocity_gradient, double time) {
    std::array<double, D * D> w{}, result{};
    double angle2 = 0;
    for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) {
            w[a * D + b] = 0.5 * (velocity_gradient[a * D + b] - velocity_gradient[b * D + a]) * time;
            angle2 += 0.5 * w[a * D + b] * w[a * D + b];
        }
    double sine_ratio = 1 - angle2 / 6 * (1 - angle2 / 20 * (1 - angle2 / 42));
    double cosine_ratio = 0.5 - angle2 / 24 * (1 - angle2 / 30 * (1 - angle2 / 56));
    if (angle2 > 1e-3) {
        const double angle = std::sqrt(angle2);
        sine_ratio = std::sin(angle) / angle;
        cosine_ratio = (1 - std::cos(angle)) / angle2;
    }
    for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) {
            double square = 0;
            for (int c = 0; c < D; ++c) square += w[a * D + c] * w[c * D + b];
            result[a * D + b] = (a == b ? 1.0 : 0.0) + sine_ratio * w[a * D + b] + cosine_ratio * square;
        }
    return result;
}

/// Deviatoric stress after `time` under a constant velocity gradient L: Hooke's law with the Jaumann rate,
/// dS/dt = 2 mu dev(e) + W S - S W with e and W the symmetric and skew parts of L. The rotation is exact and
/// the strain is added half before and half after it, so that the update is symmetric in time. K. Sugiura, S.
/// Inutsuka, J. Comput. Phys. 333 (2017) 78, eqs 4-6, in Cauchy form. In 1D and 2D the missing diagonal is
/// implied by a traceless stress: uniaxial and plane strain.
template <int D>
std::array<double, sph::symmetric_count<D>> advanced_stress(
    const std::array<double, sph::symmetric_count<D>>& stress,
    const std::array<double, D * D>& velocity_gradient, double shear_modulus, double time) {
    using sph::symmetric_index;
    std::array<double, sph::symmetric_count<D>> strained = stress, half_strain{};
    double trace = 0;
    for (int a = 0; a < D; ++a) trace += velocity_gradient[a * D + a];
    for (int a = 0; a < D; ++a)
        for (int b = a; b < D; ++b) {
            const double rate = 0.5 * (velocity_gradient[a * D + b] + velocity_gradient[b * D + a]) -
                                (a == b ? trace / 3 : 0.0);
            half_strain[symmetric_index<D>(a, b)] = shear_modulus * time * rate;
        }
    for (std::size_t c = 0; c < strained.size(); ++c) strained[c] += half_strain[c];
    if constexpr (D == 1) {
        strained[0] += half_strain[0];
        return strained;
    } else {
        const auto r = rotation<D>(velocity_gradient, time);
        const auto at = [&strained](int a, int b) {
            return strained[symmetric_index<D>(a < b ? a : b, a < b ? b : a)];
        };
        std::array<double, sph::symmetric_count<D>> result;
        for (int a = 0; a < D; ++a)
            for (int b = a; b < D; ++b) {
                double sum = 0;
                for (int c = 0; c < D; ++c)
                    for (int d = 0; d < D; ++d) sum += r[a * D + c] * at(c, d) * r[b * D + d];
                result[symmetric_index<D>(a, b)] = sum + half_strain[symmetric_index<D>(a, b)];
            }
        return result;
    }
}

}  // namespace talus
