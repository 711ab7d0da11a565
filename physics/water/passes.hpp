#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "domain/cell_table.hpp"
#include "domain/particles.hpp"
#include "physics/sph/passes.hpp"
#include "physics/sph/walls.hpp"
#include "physics/water/settings.hpp"

namespace talus::water {

/// The field that pressure follows from: of water with grains in it that of the water itself, else the
/// predicted one.
const Field<double>& density_of_fluid(const ParticleSet& particles);

/// Fills pressure and partner_volume of own particles from predicted_density; of walls nothing. With grains
/// in the water, predicted_density is mass for each volume of space, and fluid_density that over the share
/// that grains leave.
void find_pressure(ParticleSet& particles, const Settings& settings, std::span<const sph::WallNow> walls);

/// Extrapolates pressure and velocity of the water in front of them into the particles of walls, so that sums
/// over them are complete: p_w = sum (p_j + rho_j (g - a_w).(x_w - x_j)) W / sum W, no less than zero; the
/// velocity of a wall that does not slip mirrored about that of the wall, 2 v_w - sum v_j W / sum W; their
/// volume that of water under that pressure. S. Adami, X. Y. Hu, N. A. Adams, J. Comput. Phys. 231 (2012)
/// 7057, eqs 22-27. `walls`: one a body. Reads position, predicted_velocity, predicted_density, pressure and
/// partner_volume of partners; writes predicted_velocity, pressure and partner_volume of own wall particles.
void wall_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
               std::span<const sph::WallNow> walls);

/// Acceleration, gravity included, and density_rate of the water:
///
///     dv_i/dt = -(1/rho_i) sum_j V_j (p_i + p_j + P_ij) grad W_ij + (1/rho_i) sum_j V_j (mu_i + mu_j) F_ij
///     v_ij drho_i/dt = rho_i sum_j V_j v_ij . grad W_ij + 2 delta h c0 sum_j V_j (rho_i - rho_j - R_ij) F_ij
///
/// with grad W_ij = F_ij r_ij, artificial viscosity P_ij = -alpha rho0 c0 h min(v_ij . r_ij, 0)/(r_ij^2 +
/// 0.01 h^2) (J. J. Monaghan, Annu. Rev. Astron. Astrophys. 30 (1992) 543, eqs 4.1-4.2), viscosity of J. P.
/// Morris, P. J. Fox, Y. Zhu, J. Comput. Phys. 136 (1997) 214, eq. 22, and diffusion of the density less that
/// of water at rest, R_ij = rho0 g . r_ij/c0^2 (G. Fourtakas et al., Comput. Fluids 190 (2019) 346, eqs
/// 12-14), between water alone. Reads position, predicted_velocity, predicted_density, pressure,
/// partner_volume of partners.
void force_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
                std::span<const sph::WallNow> walls, sph::PassCount& count);

}  // namespace talus::water
