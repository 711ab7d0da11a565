#pragma once
#include <array>
#include <cmath>

#include "physics/sph/small_vectors.hpp"

namespace talus::depth {

/// Corrects a gradient from differences, sum A (f_j - f_i) grad W, by the inverse of its moments M = sum A
/// (x_j - x_i) grad W, so that it is exact for linear f: J. Bonet, T.-S. L. Lok, Comput. Methods Appl. Mech.
/// Eng. 180 (1999) 97. Where partners are so few or lie so much in a row that an eigenvalue of M is below
/// `least_moment`, less is made of that direction; `lost` is then the part of a linear field's gradient that
/// is missing, and zero elsewhere.
template <int D>
struct CorrectedGradient {
    using Vector = sph::Vector<double, D>;
    using Moments = sph::Symmetric<double, D>;
    static constexpr double least_moment = 0.01;

    Vector gradient, lost;

    /// `slope`: gradient of the field whose missing part is asked for.
    CorrectedGradient(const Vector& sum, const Moments& moments, const Vector& slope) : gradient{}, lost{} {
        if constexpr (D == 1) {
            const double inverse = inverted(moments[0]);
            gradient[0] = inverse * sum[0];
            if (moments[0] < least_moment) lost[0] = (1 - inverse * moments[0]) * slope[0];
        } else {
            const double mean = 0.5 * (moments[0] + moments[1]), half = 0.5 * (moments[0] - moments[1]);
            const double radius = std::sqrt(half * half + moments[2] * moments[2]);
            const double first = mean + radius, second = mean - radius;
            const double inverse_first = inverted(first), inverse_second = inverted(second);
            gradient = times(inverse_first, inverse_second, half, moments[2], radius, sum);
            if (second < least_moment)
                lost = times(lost_part(first), lost_part(second), half, moments[2], radius, slope);
        }
    }

  private:
    static double inverted(double eigenvalue) {
        return eigenvalue >= least_moment ? 1 / eigenvalue : eigenvalue / (least_moment * least_moment);
    }
    static double lost_part(double eigenvalue) {
        return eigenvalue >= least_moment ? 0 : 1 - eigenvalue * inverted(eigenvalue);
    }
    /// v times the tensor with these eigenvalues and the eigenvectors of (half, mixed; mixed, -half).
    static Vector times(double first, double second, double half, double mixed, double radius,
                        const Vector& v) {
        const double mean = 0.5 * (first + second), apart = radius > 0 ? 0.5 * (first - second) / radius : 0;
        return {(mean + apart * half) * v[0] + apart * mixed * v[1],
                apart * mixed * v[0] + (mean - apart * half) * v[1]};
    }
};

}  // namespace talus::depth
