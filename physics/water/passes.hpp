#pragma once
#include <span>

#include "domain/cell_table.hpp"
#include "domain/particles.hpp"
#include "physics/sph/passes.hpp"
#include "physics/sph/walls.hpp"
#include "physics/water/settings.hpp"

namespace talus::water {

/// Fills pressure and what partners see of own particles, predicted `time` ahead of the state with the rates
/// of the last evaluation. `walls`: one a body, or empty; theirs are as if no water were near.
void prepare_partners(ParticleSet& particles, const Settings& settings, std::span<const sph::WallNow> walls,
                      double time);

/// Extrapolates pressure and velocity of the water in front of them into the own particles of walls, so that
/// sums over them are complete: p_w = sum (p_j + rho_j (g - a_w).(x_w - x_j)) W / sum W, no less than zero;
/// the velocity of a wall that does not slip mirrored about that of the wall, 2 v_w - sum v_j W / sum W;
/// their volume that of water under that pressure. S. Adami, X. Y. Hu, N. A. Adams, J. Comput. Phys. 231
/// (2012) 7057, eqs 22-27. Reads position and partner_* of water.
void wall_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
               std::span<const sph::WallNow> walls);

/// Viscosity of the own water from the rate of strain, whose gradient of the velocity is corrected to be
/// exact for linear fields (J. Bonet, T.-S. L. Lok, Comput. Methods Appl. Mech. Eng. 180 (1999) 97). Walls
/// that slip have no part in it. Needs `settings.rheology`; reads position, partner_velocity, partner_volume
/// and partner_density of partners, writes viscosity, partner_viscosity and
/// partner_gradient.
void rate_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings);

/// Acceleration, gravity included, and density_rate of the water:
///
///     dv_i/dt = -(1/rho_i) sum_j V_j (p_i + p_j + P_ij) grad W_ij + (1/rho_i) sum_j V_j 2 mu F_ij v_ij + g
///     drho_i/dt = rho_i sum_j V_j v_ij . grad W_ij + 2 delta h c0 sum_j V_j (rho_i - rho_j - R_ij) F_ij
///
/// with grad W_ij = F_ij r_ij, artificial viscosity P_ij = -alpha rho0 c0 h min(v_ij . r_ij, 0)/(r_ij^2 +
/// 0.01 h^2) (J. J. Monaghan, Annu. Rev. Astron. Astrophys. 30 (1992) 543, eqs 4.1-4.2), viscosity of J. P.
/// Morris, P. J. Fox, Y. Zhu, J. Comput. Phys. 136 (1997) 214, eq. 22, and diffusion of the density less that
/// of water at rest, R_ij = rho0 g . r_ij/c0^2 (G. Fourtakas et al., Comput. Fluids 190 (2019) 346, eqs
/// 12-14), between water alone. With shifting also
/// shift_velocity, -4 h U sum_j V_j (1 + 0.2 (W_ij/W(spacing))^4) grad W_ij, U = c0/10, at most U/2, and none
/// near a free surface: P. N. Sun et al., Comput. Methods Appl. Mech. Eng. 315 (2017) 25, eq. 23. Walls that
/// slip have no viscosity. In three dimensions and without rheology, water nearer than settings.wall_core to
/// a particle of a wall feels 4 rho0 c0^2 (1 - r/wall_core) more pressure of that. With `settings.rheology`
/// the second sum is of 2 mu_ij F_ij (v_ij + (G_i + G_j)^T r_ij/2), mu_ij the harmonic mean (P. W. Cleary, J.
/// J. Monaghan, J. Comput. Phys. 148 (1999) 227) and G that of rate_pass(): the stress of a viscosity that
/// differs from place to place, mu (grad v + grad v^T), none in a rigid turn; walls have viscosity and G of
/// the water. Reads position and partner_* of partners.
void force_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
                sph::PassCount& count);

}  // namespace talus::water
