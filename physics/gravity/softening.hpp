#pragma once
#include <array>
#include <cstddef>

#include "physics/sph/settings.hpp"

namespace talus::gravity {

/// Field of a point mass spread out as the SPH kernel W(r, h): with q = r/h and the kernel's support s,
///   acceleration  -G m force(q)/h^3 r,    force(q) = M(q)/q^3, M the kernel's mass within q
///   potential     -G m potential(q)/h,    d potential/dq = -q force(q)
/// for q <= s, and those of a point beyond. `force` is a polynomial through Chebyshev-Lobatto nodes (exact
/// for Wendland's kernels, M to 1e-6 for the Gaussian cut at up to 2.5 h, to 2e-4 for the cubic spline and
/// the Gaussian cut at 4 h) and ends at 1/s^3; `potential` is its exact integral, so that energy is conserved
/// whatever the fit. W. Dehnen, Mon. Not. R. Astron. Soc. 324 (2001) 273, section 2.
template <class Scalar>
struct Softening {
    static constexpr std::size_t force_terms = 13, potential_terms = 15;
    Scalar support;
    std::array<Scalar, force_terms> force_coefficients;  ///< of powers of 2 q/s - 1
    std::array<Scalar, potential_terms> potential_coefficients;

    /// `Real`: Scalar or a pack of them. q must not exceed the support.
    template <class Real>
    Real force(Real q) const {
        return polynomial(force_coefficients, q);
    }
    template <class Real>
    Real potential(Real q) const {
        return polynomial(potential_coefficients, q);
    }

  private:
    template <std::size_t N, class Real>
    Real polynomial(const std::array<Scalar, N>& c, Real q) const {
        const Real z = q * (Scalar(2) / support) - Scalar(1);
        Real value = c[N - 1] * z + c[N - 2];
        for (std::size_t k = N - 2; k-- > 0;) value = value * z + c[k];
        return value;
    }
};

/// Softening by the kernel that the settings name; a tenth of a millisecond.
Softening<double> softening_of(const sph::Settings& settings);

/// The same with another kind of numbers.
template <class Scalar>
Softening<Scalar> rounded(const Softening<double>& softening) {
    Softening<Scalar> result;
    result.support = static_cast<Scalar>(softening.support);
    for (std::size_t k = 0; k < result.force_terms; ++k)
        result.force_coefficients[k] = static_cast<Scalar>(softening.force_coefficients[k]);
    for (std::size_t k = 0; k < result.potential_terms; ++k)
        result.potential_coefficients[k] = static_cast<Scalar>(softening.potential_coefficients[k]);
    return result;
}

}  // namespace talus::gravity
