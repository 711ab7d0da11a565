#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "physics/soil/constitutive.hpp"
#include "physics/soil/stencils.hpp"

namespace talus::soil {

// Runge-Kutta Taylor-SPH: T. Blanc, M. Pastor, Int. J. Numer. Anal. Meth. Geomech. 37 (2013) 1, after the
// two-step Taylor-Galerkin method of J. Peraire (1986): nodes hold the state at full steps, elements the
// state half a step later, from which nodes take the fluxes of the full step. Here both interpolations are
// exact for linear fields; the body force is not a source but added in both steps (decision 020).

inline constexpr std::uint64_t no_id = ~std::uint64_t{0};

/// What a step needs besides the particles.
struct StepSettings {
    double time_step = 0;                ///< [s]
    double spacing = 0;                  ///< of nodes at the start [m]
    std::array<double, 3> body_force{};  ///< [m/s2]
    double strength_factor = 1;          ///< on yield surfaces [1]
    double damping = 0;                  ///< rate at which velocities decay [1/s]
    /// Share of what elements cannot see of the velocity and of the stress that is taken away a step [1].
    double hourglass = 0, stress_smoothing = 0;
    std::span<const Material> materials;  ///< one a body
};

/// What a step remembers between its parts.
struct StepMemory {
    std::vector<double> unseen;         ///< of each node's state, in order of Stencils::unseen
    std::size_t width = 0;              ///< components of it a node
    std::vector<double> face_velocity;  ///< before the step, in order of Stencils::to_faces
    std::vector<double> tractions;      ///< of gather_tractions()
    std::vector<double> face_gradient;  ///< of Stencils::face_gradients, D x D a row
};

/// Sources: nodes' stress relaxes beyond the yield surface, velocities are damped. The least id of a node
/// whose stress returns too fast for relax(), or no_id.
std::uint64_t apply_sources(ParticleSet& particles, const Stencils& stencils, const StepSettings& settings);

/// What no element sees of the nodes' state, as far as some of it is to be taken away.
void gather_unseen(ParticleSet& particles, const StencilRows& rows, const StepSettings& settings,
                   StepMemory& memory);

/// What the velocity gradient on faces gets from the nodes around.
void gather_face_gradients(ParticleSet& particles, const StencilRows& rows, StepMemory& memory);

/// Velocity and stress of elements half a step ahead of the nodes.
void advance_elements(ParticleSet& particles, const StencilRows& rows, Cells which,
                      const StepSettings& settings);

/// Velocity and stress of nodes within by a full step, and the velocity of those on faces, from the elements
/// half a step ahead and the stress imposed on faces.
void advance_nodes(ParticleSet& particles, const Stencils& stencils, Cells which,
                   const StepSettings& settings, StepMemory& memory);

/// Stress of nodes on faces, once conditions on velocities hold.
void advance_face_stress(ParticleSet& particles, const Stencils& stencils, const StepSettings& settings,
                         const StepMemory& memory);

/// Moves the displacement of nodes on, once boundary conditions hold.
void displace(ParticleSet& particles, const Stencils& stencils, double time_step);

/// Stress of a particle.
Tensor stress_at(const ParticleSet& particles, std::size_t i);
void put_stress(ParticleSet& particles, std::size_t i, const Tensor& stress);

}  // namespace talus::soil
