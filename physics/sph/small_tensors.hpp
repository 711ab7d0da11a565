#pragma once
#include <array>
#include <cmath>

#include "domain/fields.hpp"

namespace talus::sph {

template <int D>
inline constexpr int symmetric_count = D*(D + 1) / 2;

/// Place of (a, b) in the storage of a symmetric tensor (domain/fields.hpp).
template <int D>
constexpr int symmetric_index(int a, int b) {
    if (a == b) return a;
    if constexpr (D == 2) return 2;
    return D + a + b - 1;  // (0,1) (0,2) (1,2)
}

/// Inverse of a symmetric matrix; the identity where the matrix is close to singular (few partners).
template <int D>
std::array<double, symmetric_count<D>> inverse_or_identity(const std::array<double, symmetric_count<D>>& m) {
    constexpr double least_determinant = 0.01;
    std::array<double, symmetric_count<D>> inverse{};
    for (int d = 0; d < D; ++d) inverse[d] = 1;
    if constexpr (D == 1) {
        if (m[0] > least_determinant) inverse[0] = 1 / m[0];
    } else if constexpr (D == 2) {
        const double det = m[0] * m[1] - m[2] * m[2];
        if (det > least_determinant) inverse = {m[1] / det, m[0] / det, -m[2] / det};
    } else {
        const double xx = m[1] * m[2] - m[5] * m[5], xy = m[4] * m[5] - m[3] * m[2],
                     xz = m[3] * m[5] - m[1] * m[4];
        const double det = m[0] * xx + m[3] * xy + m[4] * xz;
        if (det > least_determinant)
            inverse = {
                xx / det, (m[0] * m[2] - m[4] * m[4]) / det, (m[0] * m[1] - m[3] * m[3]) / det, xy / det,
                xz / det, (m[3] * m[4] - m[0] * m[5]) / det};
    }
    return inverse;
}

}  // namespace talus::sph
