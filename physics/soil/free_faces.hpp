#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "physics/soil/constitutive.hpp"
#include "physics/soil/stencils.hpp"
#include "physics/soil/taylor_galerkin.hpp"

/// Faces of saturated soil that nothing holds and that let no water through. The water's volume there changes
/// with the velocity of the nodes on the face, which is taken half a step ahead with the new pressure:
/// explicit, the stiffness of the water would make it unstable. The divergence is that of the strain of the
/// skeleton there, the mean of the elements around (Stencils::face_gradients): with any other, modes along
/// the face grow. Decision 035.
namespace talus::soil {

struct FreeFaces {
    bool any = false;  ///< a tight face that moves as it will, on any rank
    /// Of each row of Stencils::to_faces, bit a: its velocity along axis a is not imposed.
    std::span<const std::uint8_t> free_axes;
    const StepMemory* memory = nullptr;  ///< tractions and what elements do not see of velocities
    double hourglass = 0;                ///< as StepSettings
    std::array<double, 3> body_force{};  ///< [m/s2]

    /// How much more than the step itself, of its share, the pressure's equation lets a face give way to what
    /// the pressure is beyond 2 p_n - p_(n-1). Needs soil_field::earlier_pore_pressure unless it is 0.
    double extra_yielding = 0;
    /// What 2D and 3D need. 0 is unstable from a thousand times the stiffness of the skeleton on, and sooner
    /// where a drained face meets a tight one (tools/soil_tight_faces).
    static constexpr double enough_yielding = 0.35;
};

/// Into soil_field::pressure_flux of nodes their velocity, that of nodes on faces half a step ahead but for
/// the pore pressure. Elements and their copies hold the effective stress half a step ahead.
void predict_face_velocities(ParticleSet& particles, const Stencils& stencils, const FreeFaces& faces,
                             std::span<const Material> materials, double time_step);

/// Into soil_field::pressure_flux of nodes what the pressure_guess of elements takes off those velocities.
void press_faces(ParticleSet& particles, const Stencils& stencils, const FreeFaces& faces,
                 std::span<const Material> materials, double time_step);

/// What the pressure_flux of nodes adds to the divergence at the node of a row of Stencils::to_faces, once
/// copies are fresh.
template <int D>
double divergence_of_face(const std::array<const double*, D>& of_nodes, const Stencils& stencils,
                          std::uint32_t row) {
    const std::uint32_t i = stencils.to_faces.targets[row];
    const double* own = stencils.own_weights.data() + std::size_t{row} * D;
    double found = 0;
    for (std::size_t a = 0; a < D; ++a) found += own[a] * of_nodes[a][i];
    if constexpr (D > 1) {
        const StencilRows& more = stencils.face_gradients;
        const double* weight = more.weights.data() + std::size_t{more.first[row]} * D;
        for (std::uint32_t k = more.first[row]; k < more.first[row + 1]; ++k, weight += D)
            for (std::size_t a = 0; a < D; ++a) found += weight[a] * of_nodes[a][more.partners[k]];
    }
    return found;
}

}  // namespace talus::soil
