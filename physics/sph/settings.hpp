#pragma once
#include <cstdint>

namespace talus::sph {

enum class Formulation : std::uint8_t { godunov, standard };
enum class KernelKind : std::uint8_t { gaussian, cubic_spline, wendland_c2, wendland_c4, wendland_c6 };
enum class DensityMethod : std::uint8_t { continuity, summation };

/// How the specific volume is interpolated between two particles (Godunov SPH).
enum class Interpolation : std::uint8_t { linear, cubic, quintic };

/// Choices and parameters of the SPH method; what a scene's [sph] table says.
struct Settings {
    Formulation formulation = Formulation::godunov;
    KernelKind kernel = KernelKind::gaussian;
    double cutoff = 2;  ///< of the Gaussian [h]; other kernels end at 2 h
    DensityMethod density = DensityMethod::continuity;
    bool variable_smoothing_length = false;
    bool uniform_smoothing_length = true;  ///< all particles have the same h (found by the simulation)
    double eta = 1;                        ///< h = eta (m / rho)^(1/D) when it varies
    double smoothing_widening = 1;         ///< C_smooth: the density that sets h is smoothed over C_smooth h
    double largest_smoothing_length = 0;   ///< cap of h [m]; 0: none

    // Godunov SPH
    Interpolation compressed = Interpolation::linear;  ///< for pairs with P_i + P_j > 0
    Interpolation stretched = Interpolation::cubic;    ///< for pairs with P_i + P_j < 0
    bool riemann = true;                               ///< false: mean pressure, no dissipation
    bool second_order = true;                          ///< linear reconstruction with limiter
    bool riemann_velocity = false;  ///< v* from the Riemann problem (gases) instead of interpolation
    double shock_slope =
        1;  ///< s in W^2 = rho (rho c^2 + s (p* - p)); (gamma + 1)/2 for a gas, about 2 for rock

    bool several_bodies = false;  ///< contacts between bodies bear neither tension nor shear

    // Standard SPH
    double viscosity_alpha = 1;
    double viscosity_beta = 2;

    double courant = 0.5;  ///< C in dt = C h / (c + h |div v|)

    bool uses(Interpolation kind) const {
        return formulation == Formulation::godunov && (compressed == kind || stretched == kind);
    }
    /// Range of the kernel and of the pair forces in smoothing lengths.
    double kernel_support() const { return kernel == KernelKind::gaussian ? cutoff : 2; }
    double force_support() const {
        return formulation == Formulation::godunov ? 1.4142135623730951 * cutoff : kernel_support();
    }
};

/// The interpolation that is stable for either sign of the pressure: K. Sugiura, S. Inutsuka, J. Comput.
/// Phys. 308 (2016) 171, section 3 and appendix; sign of the pressure term at the Nyquist wave number.
constexpr Interpolation stable_compressed(int dimension) {
    return dimension == 1 ? Interpolation::cubic : Interpolation::linear;
}
constexpr Interpolation stable_stretched(int dimension) {
    return dimension == 1 ? Interpolation::quintic : Interpolation::cubic;
}

/// Width of the Gaussian in spacings and where it is cut [h], Godunov SPH.
struct GaussianDefaults {
    double eta, cutoff;
};

/// In 1D and 2D a cut far out costs little. In 3D compressed lattices pair the faster the more the slope of
/// the Gaussian jumps at its end, so that for given partners the narrower one is the more stable; below 0.7
/// spacings stretched ones clump (docs/decisions/010-width-of-the-gaussian.md). Gases, whose smoothing length
/// varies, shear their lattice in a shock, and need a wider one to be right behind it.
constexpr GaussianDefaults gaussian_defaults(int dimension, bool variable_smoothing_length) {
    if (dimension == 1) return {1, 4};
    if (dimension == 2) return {1, 3};
    return variable_smoothing_length ? GaussianDefaults{1, 2.5} : GaussianDefaults{0.72, 2.78};
}

}  // namespace talus::sph
