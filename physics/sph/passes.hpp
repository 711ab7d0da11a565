#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "domain/cell_table.hpp"
#include "domain/particles.hpp"
#include "physics/sph/settings.hpp"

namespace talus::sph {

/// The pair loops of SPH. Each visits the own particles of the selected cells and, for each, its partners in
/// canonical order; each writes to the visited particle alone.

/// What a pass did: the number of pairs it evaluated, and per own cell (in the order of the table's own
/// cells) the work, which decomposition balances.
struct PassCount {
    std::uint64_t pairs = 0;
    std::vector<double> work_of_cell;
};

/// Density by summation, rho_i = sum_j m_j W(r_ij, h_i), into predicted_density; with a variable smoothing
/// length also the new smoothing_length h_i = eta (m_i / rho*_i)^(1/D), rho* smoothed over smoothing_widening
/// * h_i. Reads position, mass, smoothing_length of partners.
void density_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings);

/// Gradients at each particle, from kernel sums over partners: velocity_gradient and pressure_gradient
/// corrected so that linear fields are exact (J. Bonet, T.-S. L. Lok, Comput. Methods Appl. Mech. Eng. 180
/// (1999) 97), and the raw volume_gradient -(1/rho_i^2) sum_j m_j grad W. The last two only if the set has
/// those fields. Reads position, mass, predicted_velocity, predicted_density, pressure of partners.
void gradient_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings);

/// Second derivatives of the specific volume, sum_j (m_j / rho_j) grad V_j grad W, symmetrised; for the
/// quintic. Reads position, mass, predicted_density, volume_gradient of partners.
void curvature_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings);

/// Acceleration and specific_power of Godunov SPH: K. Sugiura, S. Inutsuka, J. Comput. Phys. 308 (2016) 171,
/// eq. 55, and 333 (2017) 78, eqs 32-34, with V_ij^2 by settings.
/// Riemann states are not advanced in time: the leapfrog centres forces already. Reads every halo field of
/// partners.
void godunov_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
                  PassCount& count);

/// Acceleration and specific_power of standard SPH with Monaghan's artificial viscosity.
/// J. J. Monaghan, Rep. Prog. Phys. 68 (2005) 1703, eqs 3.3, 4.2; energy in the pairwise compatible form.
/// Reads position, mass, predicted_velocity, predicted_density, pressure, sound_speed, predicted_stress of
/// partners.
void standard_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
                   PassCount& count);

}  // namespace talus::sph
