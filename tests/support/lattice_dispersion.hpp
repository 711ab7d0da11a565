#pragma once

namespace talus::reference {

/// Interpolation of the specific volume between two particles. `quintic_as_printed` keeps the misprint
/// of the source (see godunov_omega_squared), for comparison only.
enum class Interpolation { linear, cubic, quintic, quintic_as_printed };

/// A longitudinal wave along an axis of a line, square or simple cubic lattice of equal particles with a
/// Gaussian kernel, constant smoothing length and P = C^2 (rho - rho_0), without viscosity or strength.
struct LatticeWave {
    int dimension = 1;
    double spacing = 1;           ///< of the lattice [m]
    double smoothing_length = 1;  ///< h [m]
    double density = 1;           ///< unperturbed; mass of a particle = density * spacing^dimension [kg/m3]
    double sound_speed = 1;       ///< C [m/s]
    double pressure = 0;          ///< unperturbed, of either sign [Pa]
    /// W(r, h) is zero from r = cutoff h on, and W(r, sqrt2 h) from cutoff sqrt2 h on. A perturbed lattice
    /// with neighbours exactly at the cut would gain and lose them: choose a cut between two shells.
    double cutoff = 6;
    double gradient_scale = 1;  ///< factor on the kernel, for one renormalised after the cut [1]
};

/// omega^2 [1/s2] of Godunov SPH with P* = (P_i + P_j) / 2; negative: the lattice clumps at the rate
/// sqrt(-omega^2). `wavenumber` [1/m], up to pi / spacing.
/// K. Sugiura, Development of a Numerical Simulation Method for Rocky Body Impacts, Springer Theses 2020,
/// ch. 2 appendix, eqs 2.134 (linear), 2.136 (cubic), 2.138 (quintic). As printed, the three A_{2,m} terms
/// of 2.138 have the sign opposite to what 2.133 implies; they are reversed here, and a direct
/// linearisation of the equations of motion (tests/unit/reference_lattice_dispersion.cpp) agrees.
double godunov_omega_squared(const LatticeWave& wave, Interpolation interpolation, double wavenumber);

/// omega^2 [1/s2] of standard SPH, a_i = -sum_j m_j (P_i/rho_i^2 + P_j/rho_j^2) grad W(r_ij, h), with the
/// density summed or integrated by continuity. J. P. Morris, PhD thesis, Monash University 1996, ch. 4.
double standard_omega_squared(const LatticeWave& wave, double wavenumber);

}  // namespace talus::reference
