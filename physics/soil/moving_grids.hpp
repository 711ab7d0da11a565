#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "domain/cell_table.hpp"
#include "domain/particles.hpp"
#include "physics/soil/boundary_conditions.hpp"
#include "physics/soil/stencils.hpp"
#include "physics/soil/taylor_galerkin.hpp"

namespace talus::soil {

// Taylor-SPH in large deformation: nodes and elements move with the soil and find each other anew every step.
// Each element fits its nodes linearly by moving least squares (weights w, gradients g); nodes use the same
// weights, so that one set of them makes all operators:
//   element  s_e = sum w s_i + dt/2 (rate of s)(sum g v_i)                             half a step ahead
//            p_e = J s_e f^-T with f = 1 + dt/2 sum g v_i, J = det f: the torque vanishes half way, too
//   node     m dv/dt = -sum V_e g . (p_e - C p_i) + loads, p_i = sum V_e w p_e / sum V_e w
//   element  l_e = sum g (v_i + v_i')/2, V_e -> det(1 + dt l_e) V_e
//   node     the stress of the deformation 1 + dt sum V_e w l_e / sum V_e w (hencky_stress)
// C projects away from the normal of a free surface, and is 1 within: forces of a stress without gradient
// vanish there, without which the scheme is unstable under stress of either sign (decision 024).

/// Smoothing length over the spacing; Wendland's kernel ends at twice that.
inline constexpr double default_moving_smoothing = 1;
inline constexpr double moving_search_range = 2;

/// What a step remembers between its parts, in order of the rows' targets.
struct MovingMemory {
    std::vector<double> volume;  ///< sum V_e w of nodes [m^D]
};

/// Fields that moving grids need besides; `smooth_stress`: with StepSettings::stress_smoothing.
void add_moving_fields(ParticleSet& particles, bool smooth_stress);

/// Own nodes and elements as targets of to_nodes and to_elements, without partners yet: those of cells that
/// need no copies first.
void list_targets(const ParticleSet& particles, const CellTable& table, Stencils& stencils);

/// Elements fit their nodes and predict their stress half a step ahead. Needs the copies' positions,
/// smoothing lengths, grids, velocities and stresses.
void predict_elements(ParticleSet& particles, const CellTable& table, Cells which,
                      const StepSettings& settings, StencilRows& rows);

/// Velocity of nodes by a full step, without loads on faces; soil_field::middle_velocity holds the one
/// before. Needs the copies' fits.
void accelerate_nodes(ParticleSet& particles, const CellTable& table, Cells which,
                      const StepSettings& settings, StencilRows& rows, MovingMemory& memory);

/// soil_field::middle_velocity becomes the mean of the velocities before and after the step.
void centre_velocities(ParticleSet& particles, const Stencils& stencils);

/// Velocity and its gradient in elements in the middle of the step. Needs the copies' middle velocities.
void measure_elements(ParticleSet& particles, Cells which, const StencilRows& rows);

/// Nodes strain, turn their surface and move by what elements see of their velocity, or as they are held.
/// Needs the copies' velocities and gradients.
void deform_nodes(ParticleSet& particles, Cells which, const StepSettings& settings,
                  std::span<const BoundaryCondition> conditions, const StencilRows& rows,
                  const MovingMemory& memory);

/// Elements move and change their volume, once no node needs them any more.
void move_elements(ParticleSet& particles, const StencilRows& rows, double time_step);

}  // namespace talus::soil
