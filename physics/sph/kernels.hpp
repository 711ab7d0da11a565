#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "domain/lanes.hpp"

namespace talus::sph {

/// exp(-x) for 0 <= x <= 10 to 1e-14 (1e-11 up to 16), of additions and multiplications alone so that lanes
/// can share it: a polynomial for exp(-x/32), squared five times.
template <class Real>
Real exp_minus(Real x) {
    constexpr double centre = 0.15625;
    const Real z = centre - x * (1.0 / 32);
    Real p = z * (1.0 / 3628800) + 1.0 / 362880;
    p = p * z + 1.0 / 40320;
    p = p * z + 1.0 / 5040;
    p = p * z + 1.0 / 720;
    p = p * z + 1.0 / 120;
    p = p * z + 1.0 / 24;
    p = p * z + 1.0 / 6;
    p = p * z + 0.5;
    p = p * z + 1;
    p = p * z + 1;
    constexpr double exp_minus_centre = 0.8553453273074225;
    p *= exp_minus_centre;
    p *= p;
    p *= p;
    p *= p;
    p *= p;
    return p * p;
}

/// A kernel W(r, h) in D dimensions has a support radius support() * h and gives, for doubles or lanes,
///   value(r2, inverse_h):  W [1/m^D]
///   factor(r2, inverse_h): (1/r) dW/dr [1/m^(D+2)], so that grad_i W_ij = factor * (x_i - x_j),
///   self_excess(partners): share of a particle's own W(0, h) by which sums over even spreads of that many
///                          particles within the support come out too high.
/// r2 is the squared distance [m2]; outside the support both are 0.

/// Gaussian exp(-r^2/h^2), cut at `cutoff` smoothing lengths and lowered by its value there, so that it ends
/// continuously, and normalised so that its integral, and with it the first moment of its gradient, are
/// exact. Uncut: S. Inutsuka, J. Comput. Phys. 179 (2002) 238, eq. 3.
template <int D>
struct Gaussian {
    explicit Gaussian(double cutoff_) : cutoff(cutoff_), edge(std::exp(-cutoff_ * cutoff_)) {
        using std::numbers::pi;
        const double q = cutoff, root_pi = std::sqrt(pi);
        double inside = std::erf(q);  // share of the uncut Gaussian's integral within the cut
        double volume = 2 * q;        // of the ball, with h = 1
        if (D == 2) {
            inside = 1 - edge;
            volume = pi * q * q;
        }
        if (D == 3) {
            inside = std::erf(q) - 2 / root_pi * q * edge;
            volume = 4.0 / 3 * pi * q * q * q;
        }
        norm = 1 / (std::pow(root_pi, D) * inside - volume * edge);
    }

    double support() const { return cutoff; }
    static constexpr double self_excess(double) { return 0; }
    template <class Real>
    Real value(Real r2, Real inverse_h) const {
        Real scale = norm * inverse_h;
        for (int d = 1; d < D; ++d) scale *= inverse_h;
        using std::min;
        const Real x = min(r2 * inverse_h * inverse_h, Real(cutoff * cutoff));
        return scale * (exp_minus(x) - edge);
    }
    template <class Real>
    Real factor(Real r2, Real inverse_h) const {
        const Real inverse_h2 = inverse_h * inverse_h;
        Real scale = -2 * norm * inverse_h2 * inverse_h;
        for (int d = 1; d < D; ++d) scale *= inverse_h;
        using std::min;
        const Real x = r2 * inverse_h2, end = Real(cutoff * cutoff);
        return select(x < end, scale * exp_minus(min(x, end)), Real(0.0));
    }

    double cutoff, edge, norm;
};

/// Kernels with support 2h, as w(q)/h^D, q = r/h: `shape` is w without its constant, `slope` is w'(q)/q.
template <int D, class Derived>
struct CompactKernel {
    double support() const { return 2; }
    static constexpr double self_excess(double) { return 0; }
    template <class Real>
    Real value(Real r2, Real inverse_h) const {
        using std::sqrt;
        const Real q = sqrt(r2) * inverse_h;
        Real scale = Derived::norm * inverse_h;
        for (int d = 1; d < D; ++d) scale *= inverse_h;
        return scale * Derived::shape(q);
    }
    template <class Real>
    Real factor(Real r2, Real inverse_h) const {
        using std::sqrt;
        const Real q = sqrt(r2) * inverse_h;
        Real scale = Derived::norm * inverse_h * inverse_h * inverse_h;
        for (int d = 1; d < D; ++d) scale *= inverse_h;
        return scale * Derived::slope(q);
    }
};

/// Cubic spline M4. J. J. Monaghan, J. C. Lattanzio, Astron. Astrophys. 149 (1985) 135, eq. 21.
template <int D>
struct CubicSpline : CompactKernel<D, CubicSpline<D>> {
    static constexpr double norm = D == 1   ? 2.0 / 3
                                   : D == 2 ? 10 / (7 * std::numbers::pi)
                                            : 1 / std::numbers::pi;
    template <class Real>
    static Real shape(Real q) {
        using std::max;
        const Real outer = max(2 - q, Real(0.0)), inner = max(1 - q, Real(0.0));
        return 0.25 * outer * outer * outer - inner * inner * inner;
    }
    template <class Real>
    static Real slope(Real q) {
        using std::max;
        const Real outer = max(2 - q, Real(0.0));
        const Real far = -0.75 * outer * outer / max(q, Real(1e-300));
        return select(q < 1, -3 + 2.25 * q, far);
    }
};

/// Wendland's functions in the form of W. Dehnen, H. Aly, Mon. Not. R. Astron. Soc. 425 (2012) 1068, table 1,
/// with support 2h. x = 1 - q/2. Excess in 3D: their eqs 18, 19; in 1D and 2D none is known.
template <int D>
struct WendlandC2 : CompactKernel<D, WendlandC2<D>> {
    static constexpr double norm = D == 1   ? 5.0 / 8
                                   : D == 2 ? 7 / (4 * std::numbers::pi)
                                            : 21 / (16 * std::numbers::pi);
    static double self_excess(double partners) {
        return D == 3 ? 0.0294 * std::pow(partners / 100, -0.977) : 0;
    }
    template <class Real>
    static Real shape(Real q) {
        using std::max;
        const Real x = max(1 - 0.5 * q, Real(0.0)), x3 = x * x * x;
        return D == 1 ? x3 * (1 + 1.5 * q) : x3 * x * (1 + 2 * q);
    }
    template <class Real>
    static Real slope(Real q) {
        using std::max;
        const Real x = max(1 - 0.5 * q, Real(0.0));
        return D == 1 ? -3 * x * x : -5 * x * x * x;
    }
};

template <int D>
struct WendlandC4 : CompactKernel<D, WendlandC4<D>> {
    static constexpr double norm = D == 1   ? 3.0 / 4
                                   : D == 2 ? 9 / (4 * std::numbers::pi)
                                            : 495 / (256 * std::numbers::pi);
    static double self_excess(double partners) {
        return D == 3 ? 0.01342 * std::pow(partners / 100, -1.579) : 0;
    }
    template <class Real>
    static Real shape(Real q) {
        using std::max;
        const Real x = max(1 - 0.5 * q, Real(0.0)), x2 = x * x, x4 = x2 * x2;
        return D == 1 ? x4 * x * (1 + 2.5 * q + 2 * q * q) : x4 * x2 * (1 + 3 * q + 35.0 / 12 * q * q);
    }
    template <class Real>
    static Real slope(Real q) {
        using std::max;
        const Real x = max(1 - 0.5 * q, Real(0.0)), x2 = x * x, x4 = x2 * x2;
        return D == 1 ? -3.5 * x4 * (1 + 2 * q) : -14.0 / 3 * x4 * x * (1 + 2.5 * q);
    }
};

template <int D>
struct WendlandC6 : CompactKernel<D, WendlandC6<D>> {
    static constexpr double norm = D == 1   ? 55.0 / 64
                                   : D == 2 ? 78 / (28 * std::numbers::pi)
                                            : 1365 / (512 * std::numbers::pi);
    static double self_excess(double partners) {
        return D == 3 ? 0.0116 * std::pow(partners / 100, -2.236) : 0;
    }
    template <class Real>
    static Real shape(Real q) {
        using std::max;
        const Real x = max(1 - 0.5 * q, Real(0.0)), x2 = x * x, x4 = x2 * x2;
        return D == 1 ? x4 * x2 * x * (1 + 3.5 * q + 19.0 / 4 * q * q + 21.0 / 8 * q * q * q)
                      : x4 * x4 * (1 + 4 * q + 25.0 / 4 * q * q + 4 * q * q * q);
    }
    template <class Real>
    static Real slope(Real q) {
        using std::max;
        const Real x = max(1 - 0.5 * q, Real(0.0)), x2 = x * x, x4 = x2 * x2;
        return D == 1 ? -0.75 * x4 * x2 * (6 + 18 * q + 17.5 * q * q)
                      : -5.5 * x4 * x2 * x * (1 + 3.5 * q + 4 * q * q);
    }
};

}  // namespace talus::sph
