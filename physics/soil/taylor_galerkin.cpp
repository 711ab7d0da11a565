#include "physics/soil/taylor_galerkin.hpp"

#include <algorithm>
#include <cmath>

#include "physics/soil/node_density.hpp"
#include "physics/soil/state_columns.hpp"

namespace talus::soil {

namespace {

template <int D>
void advance_elements_in(ParticleSet& particles, const StencilRows& rows, Cells which,
                         const StepSettings& settings) {
    using Columns = StateColumns<D>;
    const Columns columns(particles);
    const std::uint8_t* body = particles.data(field::body);
    const double half = settings.time_step / 2;
    for (std::uint32_t row = rows.begin(which); row < rows.end(which); ++row) {
        const std::uint32_t i = rows.targets[row];
        const Material& material = settings.materials[body[i]];
        FluxSums<D> sums;
        double velocity[D] = {}, stress[Columns::stresses] = {}, lateral = 0;
        const double* weight = rows.weights.data() + std::size_t{rows.first[row]} * (D + 1);
        for (std::uint32_t k = rows.first[row]; k < rows.first[row + 1]; ++k, weight += D + 1) {
            const std::uint32_t j = rows.partners[k];
            sums.add_velocity(weight + 1, columns.velocity, j);
            sums.add_stress(weight + 1, columns.stress, j);
            for (int a = 0; a < D; ++a) velocity[a] += weight[0] * columns.velocity[a][j];
            for (int c = 0; c < Columns::stresses; ++c) stress[c] += weight[0] * columns.stress[c][j];
            if (D < 3) lateral += weight[0] * columns.lateral[j];
        }
        for (int a = 0; a < D; ++a)
            columns.velocity[a][i] = velocity[a] + half * (sums.divergence[a] / material.density +
                                                           settings.body_force[static_cast<std::size_t>(a)]);
        for (int c = 0; c < Columns::stresses; ++c) columns.stress[c][i] = stress[c];
        if (D < 3) columns.lateral[i] = lateral;
        columns.add_elastic(i, material.elasticity, sums.gradient, half);
    }
}

template <int D>
void gather_unseen_in(ParticleSet& particles, const StencilRows& rows, const StepSettings& settings,
                      StepMemory& memory) {
    const auto columns = StateColumns<D>(particles).all();
    memory.width = settings.stress_smoothing > 0 ? columns.size() : settings.hourglass > 0 ? D : 0;
    memory.unseen.assign(rows.targets.size() * memory.width, 0);
    for (std::size_t row = 0; row < rows.targets.size(); ++row) {
        double* found = memory.unseen.data() + row * memory.width;
        for (std::uint32_t k = rows.first[row]; k < rows.first[row + 1]; ++k)
            for (std::size_t c = 0; c < memory.width; ++c)
                found[c] += rows.weights[k] * columns[c][rows.partners[k]];
    }
}

template <int D>
void gather_face_gradients_in(ParticleSet& particles, const StencilRows& rows, StepMemory& memory) {
    const auto velocity = sph::components<D>(particles, soil_field::velocity);
    memory.face_gradient.assign(rows.targets.size() * D * D, 0);
    for (std::size_t row = 0; row < rows.targets.size(); ++row) {
        double* found = memory.face_gradient.data() + row * D * D;
        for (std::uint32_t k = rows.first[row]; k < rows.first[row + 1]; ++k)
            for (int a = 0; a < D; ++a)
                for (int b = 0; b < D; ++b)
                    found[a * D + b] += rows.weights[std::size_t{k} * D + static_cast<std::size_t>(b)] *
                                        velocity[a][rows.partners[k]];
    }
}

/// Takes shares of what was not seen away, `row` counted over all nodes.
template <int D>
void smooth_velocity(const StateColumns<D>& columns, std::size_t i, std::size_t row,
                     const StepSettings& settings, const StepMemory& memory) {
    if (settings.hourglass == 0) return;
    const double* unseen = memory.unseen.data() + row * memory.width;
    for (int a = 0; a < D; ++a) columns.velocity[a][i] -= settings.hourglass * unseen[a];
}
template <int D>
void smooth_stress(const StateColumns<D>& columns, std::size_t i, std::size_t row,
                   const StepSettings& settings, const StepMemory& memory) {
    if (settings.stress_smoothing == 0) return;
    const double* unseen = memory.unseen.data() + row * memory.width + D;
    for (int c = 0; c < StateColumns<D>::stresses; ++c)
        columns.stress[c][i] -= settings.stress_smoothing * unseen[c];
    if (D < 3) columns.lateral[i] -= settings.stress_smoothing * unseen[StateColumns<D>::stresses];
}

template <int D>
void accelerate(const StateColumns<D>& columns, std::size_t i, const FluxSums<D>& sums, double density,
                const StepSettings& settings) {
    for (int a = 0; a < D; ++a)
        columns.velocity[a][i] += settings.time_step * (sums.divergence[a] / density +
                                                        settings.body_force[static_cast<std::size_t>(a)]);
}

template <int D>
void advance_nodes_in(ParticleSet& particles, const Stencils& stencils, Cells which,
                      const StepSettings& settings, StepMemory& memory) {
    const StateColumns<D> columns(particles);
    const NodeDensity density(particles, settings.materials);
    const std::uint8_t* body = particles.data(field::body);
    const StencilRows& rows = stencils.to_nodes;
    for (std::uint32_t row = rows.begin(which); row < rows.end(which); ++row) {
        const std::uint32_t i = rows.targets[row];
        const Material& material = settings.materials[body[i]];
        FluxSums<D> sums;
        const double* weight = rows.weights.data() + std::size_t{rows.first[row]} * D;
        for (std::uint32_t k = rows.first[row]; k < rows.first[row + 1]; ++k, weight += D) {
            sums.add_velocity(weight, columns.velocity, rows.partners[k]);
            sums.add_stress(weight, columns.stress, rows.partners[k]);
        }
        accelerate(columns, i, sums, density[i], settings);
        columns.add_elastic(i, material.elasticity, sums.gradient, settings.time_step);
        smooth_velocity(columns, i, row, settings, memory);
        smooth_stress(columns, i, row, settings, memory);
    }
    const StencilRows& faces = stencils.to_faces;
    memory.face_velocity.resize(faces.targets.size() * D);
    for (std::uint32_t row = faces.begin(which); row < faces.end(which); ++row) {
        const std::uint32_t i = faces.targets[row];
        FluxSums<D> sums;
        const double* weight = faces.weights.data() + std::size_t{faces.first[row]} * D;
        for (std::uint32_t k = faces.first[row]; k < faces.first[row + 1]; ++k, weight += D)
            sums.add_stress(weight, columns.stress, faces.partners[k]);
        for (int a = 0; a < D; ++a)
            sums.divergence[a] += memory.tractions[std::size_t{row} * D + static_cast<std::size_t>(a)];
        for (int a = 0; a < D; ++a)
            memory.face_velocity[std::size_t{row} * D + static_cast<std::size_t>(a)] = columns.velocity[a][i];
        accelerate(columns, i, sums, density[i], settings);
        smooth_velocity(columns, i, rows.targets.size() + row, settings, memory);
    }
}

template <int D>
void advance_face_stress_in(ParticleSet& particles, const Stencils& stencils, const StepSettings& settings,
                            const StepMemory& memory) {
    const StateColumns<D> columns(particles);
    const std::uint8_t* body = particles.data(field::body);
    const StencilRows& rows = stencils.to_faces;
    const std::size_t inner = stencils.to_nodes.targets.size();
    for (std::uint32_t row = 0; row < rows.targets.size(); ++row) {
        const std::uint32_t i = rows.targets[row];
        FluxSums<D> sums;
        const double* weight = rows.weights.data() + std::size_t{rows.first[row]} * D;
        for (std::uint32_t k = rows.first[row]; k < rows.first[row + 1]; ++k, weight += D)
            sums.add_velocity(weight, columns.velocity, rows.partners[k]);
        const double* own = stencils.own_weights.data() + std::size_t{row} * D;
        const double* more = memory.face_gradient.data() + std::size_t{row} * D * D;
        const double* before = memory.face_velocity.data() + std::size_t{row} * D;
        for (int a = 0; a < D; ++a)
            for (int b = 0; b < D; ++b)
                sums.gradient[a][b] += own[b] * 0.5 * (before[a] + columns.velocity[a][i]) + more[a * D + b];
        columns.add_elastic(i, settings.materials[body[i]].elasticity, sums.gradient, settings.time_step);
        smooth_stress(columns, i, inner + row, settings, memory);
    }
}

template <int D>
std::uint64_t apply_sources_in(ParticleSet& particles, const Stencils& stencils,
                               const StepSettings& settings) {
    const StateColumns<D> columns(particles);
    if (settings.damping > 0) {
        const double left = std::exp(-settings.damping * settings.time_step);
        stencils.for_each_node([&](std::uint32_t i) {
            for (int a = 0; a < D; ++a) columns.velocity[a][i] *= left;
        });
    }
    std::uint64_t too_fast = no_id;
    if (!particles.has(soil_field::viscoplastic_strain)) return too_fast;
    const std::uint8_t* body = particles.data(field::body);
    double* strain = particles.data(soil_field::viscoplastic_strain);
    double* work = particles.data(soil_field::viscoplastic_work);
    double* size =
        particles.has(soil_field::preconsolidation) ? particles.data(soil_field::preconsolidation) : nullptr;
    stencils.for_each_node([&](std::uint32_t i) {
        const Material& material = settings.materials[body[i]];
        if (!material.flows()) return;
        Tensor stress = columns.stress_at(i);
        History history{strain[i], work[i], size ? size[i] : 0};
        if (!relax(material, settings.strength_factor, settings.time_step, stress, history))
            too_fast = std::min(too_fast, particles.data(field::id)[i]);
        columns.put_stress(i, stress);
        strain[i] = history.strain;
        work[i] = history.work;
        if (size) size[i] = history.preconsolidation;
    });
    return too_fast;
}

}  // namespace

std::uint64_t apply_sources(ParticleSet& particles, const Stencils& stencils, const StepSettings& settings) {
    std::uint64_t too_fast = no_id;
    sph::with_dimension(particles, [&](auto dimension) {
        too_fast = apply_sources_in<dimension()>(particles, stencils, settings);
    });
    return too_fast;
}

void gather_unseen(ParticleSet& particles, const StencilRows& rows, const StepSettings& settings,
                   StepMemory& memory) {
    sph::with_dimension(
        particles, [&](auto dimension) { gather_unseen_in<dimension()>(particles, rows, settings, memory); });
}

void gather_face_gradients(ParticleSet& particles, const StencilRows& rows, StepMemory& memory) {
    sph::with_dimension(
        particles, [&](auto dimension) { gather_face_gradients_in<dimension()>(particles, rows, memory); });
}

void advance_elements(ParticleSet& particles, const StencilRows& rows, Cells which,
                      const StepSettings& settings) {
    sph::with_dimension(particles, [&](auto dimension) {
        advance_elements_in<dimension()>(particles, rows, which, settings);
    });
}

void advance_nodes(ParticleSet& particles, const Stencils& stencils, Cells which,
                   const StepSettings& settings, StepMemory& memory) {
    sph::with_dimension(particles, [&](auto dimension) {
        advance_nodes_in<dimension()>(particles, stencils, which, settings, memory);
    });
}

void advance_face_stress(ParticleSet& particles, const Stencils& stencils, const StepSettings& settings,
                         const StepMemory& memory) {
    sph::with_dimension(particles, [&](auto dimension) {
        advance_face_stress_in<dimension()>(particles, stencils, settings, memory);
    });
}

void displace(ParticleSet& particles, const Stencils& stencils, double time_step) {
    for (int a = 0; a < particles.dimension(); ++a) {
        const double* v = particles.data(soil_field::velocity, a);
        double* u = particles.data(soil_field::displacement, a);
        stencils.for_each_node([&](std::uint32_t i) { u[i] += time_step * v[i]; });
    }
}

Tensor stress_at(const ParticleSet& particles, std::size_t i) {
    Tensor stress{};
    sph::with_dimension(particles, [&](auto dimension) {
        // The columns are only read.
        stress = StateColumns<dimension()>(const_cast<ParticleSet&>(particles)).stress_at(i);
    });
    return stress;
}

void put_stress(ParticleSet& particles, std::size_t i, const Tensor& stress) {
    sph::with_dimension(particles,
                        [&](auto dimension) { StateColumns<dimension()>(particles).put_stress(i, stress); });
}

}  // namespace talus::soil
