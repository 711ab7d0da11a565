#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "domain/particles.hpp"

namespace talus {

/// Components of a deviatoric stress, one contiguous array each, in the order of `domain/fields.hpp`:
/// xx | xx yy xy | xx yy zz xy xz yz. T is double or const double.
template <class T>
struct StressColumns {
    int dimension = 3;
    std::array<T*, 6> component{};

    operator StressColumns<const T>() const {
        StressColumns<const T> other{dimension, {}};
        std::copy(component.begin(), component.end(), other.component.begin());
        return other;
    }
};

/// The columns of one symmetric tensor field of a particle set.
inline StressColumns<double> stress_columns(ParticleSet& particles, const Field<double>& field) {
    StressColumns<double> columns{particles.dimension(), {}};
    for (int c = 0; c < component_count(Shape::symmetric_tensor, columns.dimension); ++c)
        columns.component[static_cast<std::size_t>(c)] = particles.data(field, c);
    return columns;
}
inline StressColumns<const double> stress_columns(const ParticleSet& particles, const Field<double>& field) {
    StressColumns<const double> columns{particles.dimension(), {}};
    for (int c = 0; c < component_count(Shape::symmetric_tensor, columns.dimension); ++c)
        columns.component[static_cast<std::size_t>(c)] = particles.data(field, c);
    return columns;
}

/// A traceless symmetric stress [Pa] with all its components, those that 1D and 2D do not store included.
struct Deviator {
    double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
};

/// Deviator of entry i. The missing diagonal makes it traceless: uniaxial strain in 1D (yy = zz = -xx/2),
/// plane strain in 2D (zz = -xx - yy).
template <int dimension, class T>
Deviator deviator(const StressColumns<T>& stress, std::size_t i) {
    const auto& s = stress.component;
    if constexpr (dimension == 1) {
        return {s[0][i], -0.5 * s[0][i], -0.5 * s[0][i], 0, 0, 0};
    } else if constexpr (dimension == 2) {
        return {s[0][i], s[1][i], -s[0][i] - s[1][i], s[2][i], 0, 0};
    } else {
        return {s[0][i], s[1][i], s[2][i], s[3][i], s[4][i], s[5][i]};
    }
}

/// J2 = S:S/2 [Pa2].
inline double second_invariant(const Deviator& s) {
    return 0.5 * (s.xx * s.xx + s.yy * s.yy + s.zz * s.zz) + s.xy * s.xy + s.xz * s.xz + s.yz * s.yz;
}

/// Largest eigenvalue [Pa] of a traceless symmetric tensor, by the trigonometric root of its cubic;
/// good to 1e-7 of sqrt(J2). O. K. Smith, Commun. ACM 4 (1961) 168.
inline double largest_principal(const Deviator& s) {
    const double third = second_invariant(s) / 3;
    if (!(third > 0)) return 0;
    const double radius = std::sqrt(third), scale = 1 / radius;
    const double xx = scale * s.xx, yy = scale * s.yy, zz = scale * s.zz;
    const double xy = scale * s.xy, xz = scale * s.xz, yz = scale * s.yz;
    const double determinant = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
    const double cosine = std::clamp(0.5 * determinant, -1.0, 1.0);
    return 2 * radius * std::cos(std::acos(cosine) / 3);
}

}  // namespace talus
