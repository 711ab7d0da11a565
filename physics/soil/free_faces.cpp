#include "physics/soil/free_faces.hpp"

#include "physics/soil/node_density.hpp"
#include "physics/soil/state_columns.hpp"

namespace talus::soil {

namespace {

template <int D>
void predict_in(ParticleSet& particles, const Stencils& stencils, const FreeFaces& faces,
                std::span<const Material> materials, double time_step) {
    const StateColumns<D> columns(particles);
    const auto found = sph::components_to_write<D>(particles, soil_field::pressure_flux);
    const NodeDensity density(particles, materials);
    const StencilRows& rows = stencils.to_faces;
    const StepMemory& memory = *faces.memory;
    for (const StencilRows* all : {&stencils.to_nodes, &rows})
        for (const std::uint32_t i : all->targets)
            for (std::size_t a = 0; a < D; ++a) found[a][i] = columns.velocity[a][i];
    for (std::uint32_t row = 0; row < rows.targets.size(); ++row) {
        const std::uint32_t i = rows.targets[row];
        FluxSums<D> sums;
        const double* weight = rows.weights.data() + std::size_t{rows.first[row]} * D;
        for (std::uint32_t k = rows.first[row]; k < rows.first[row + 1]; ++k, weight += D)
            sums.add_stress(weight, columns.stress, rows.partners[k]);
        const std::size_t unseen = (stencils.to_nodes.targets.size() + row) * memory.width;
        for (std::size_t a = 0; a < D; ++a) {
            if (!(faces.free_axes[row] >> a & 1)) continue;
            found[a][i] += 0.5 * time_step *
                           ((sums.divergence[a] + memory.tractions[std::size_t{row} * D + a]) / density[i] +
                            faces.body_force[a]);
            if (faces.hourglass > 0) found[a][i] -= 0.5 * faces.hourglass * memory.unseen[unseen + a];
        }
    }
}

template <int D>
void press_in(ParticleSet& particles, const Stencils& stencils, const FreeFaces& faces,
              std::span<const Material> materials, double time_step) {
    const double* guess = particles.data(soil_field::pressure_guess);
    const auto found = sph::components_to_write<D>(particles, soil_field::pressure_flux);
    const NodeDensity density(particles, materials);
    for (const std::uint32_t i : stencils.to_nodes.targets)
        for (std::size_t a = 0; a < D; ++a) found[a][i] = 0;
    const StencilRows& rows = stencils.to_faces;
    for (std::uint32_t row = 0; row < rows.targets.size(); ++row) {
        const std::uint32_t i = rows.targets[row];
        double gradient[D] = {};
        const double* weight = rows.weights.data() + std::size_t{rows.first[row]} * D;
        for (std::uint32_t k = rows.first[row]; k < rows.first[row + 1]; ++k, weight += D)
            for (int a = 0; a < D; ++a) gradient[a] += weight[a] * guess[rows.partners[k]];
        for (std::size_t a = 0; a < D; ++a)
            found[a][i] = faces.free_axes[row] >> a & 1 ? 0.5 * time_step / density[i] * gradient[a] : 0.0;
    }
}

}  // namespace

void predict_face_velocities(ParticleSet& particles, const Stencils& stencils, const FreeFaces& faces,
                             std::span<const Material> materials, double time_step) {
    sph::with_dimension(particles, [&](auto dimension) {
        predict_in<dimension()>(particles, stencils, faces, materials, time_step);
    });
}

void press_faces(ParticleSet& particles, const Stencils& stencils, const FreeFaces& faces,
                 std::span<const Material> materials, double time_step) {
    sph::with_dimension(particles, [&](auto dimension) {
        press_in<dimension()>(particles, stencils, faces, materials, time_step);
    });
}

}  // namespace talus::soil
