#pragma once
#include <array>
#include <cstddef>

#include "physics/sph/small_tensors.hpp"

namespace talus::sph {

/// Vectors and symmetric tensors of doubles or of lanes.
template <class Real, int D>
using Vector = std::array<Real, static_cast<std::size_t>(D)>;
template <class Real, int D>
using Symmetric = std::array<Real, static_cast<std::size_t>(symmetric_count<D>)>;

template <class Real, std::size_t D>
Real dot(const std::array<Real, D>& a, const std::array<Real, D>& b) {
    Real total = a[0] * b[0];
    for (std::size_t d = 1; d < D; ++d) total += a[d] * b[d];
    return total;
}

/// e . t . e
template <class Real, std::size_t D>
Real normal_component(const Symmetric<Real, static_cast<int>(D)>& t, const std::array<Real, D>& e) {
    constexpr int dimension = static_cast<int>(D);
    Real diagonal = t[0] * e[0] * e[0];
    for (std::size_t d = 1; d < D; ++d) diagonal += t[d] * e[d] * e[d];
    if constexpr (D == 1) return diagonal;
    Real mixed = 0;
    for (int a = 0; a < dimension; ++a)
        for (int b = a + 1; b < dimension; ++b)
            mixed += t[symmetric_index<dimension>(a, b)] *
                     (e[static_cast<std::size_t>(a)] * e[static_cast<std::size_t>(b)]);
    return diagonal + 2 * mixed;
}

/// (t . r)_a
template <class Real, std::size_t D>
Real row_times(const Symmetric<Real, static_cast<int>(D)>& t, std::size_t a, const std::array<Real, D>& r) {
    const auto entry = [&](std::size_t b) {
        const int lower = static_cast<int>(a < b ? a : b), upper = static_cast<int>(a < b ? b : a);
        return t[symmetric_index<static_cast<int>(D)>(lower, upper)];
    };
    Real total = entry(0) * r[0];
    for (std::size_t b = 1; b < D; ++b) total += entry(b) * r[b];
    return total;
}

}  // namespace talus::sph
