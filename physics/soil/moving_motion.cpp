#include <algorithm>

#include "physics/soil/hencky.hpp"
#include "physics/soil/moving_columns.hpp"
#include "physics/soil/moving_grids.hpp"

namespace talus::soil {

namespace {

template <int D>
void measure_elements_in(ParticleSet& particles, Cells which, const StencilRows& rows) {
    const auto middle = sph::components<D>(particles, soil_field::middle_velocity);
    const auto velocity = sph::components_to_write<D>(particles, soil_field::velocity);
    for (std::uint32_t row = rows.begin(which); row < rows.end(which); ++row) {
        const std::uint32_t i = rows.targets[row];
        Vector<D> mean = Vector<D>::Zero();
        Matrix<D> slope = Matrix<D>::Zero();
        for (std::uint32_t k = rows.first[row]; k < rows.first[row + 1]; ++k) {
            const double* weight = rows.weights.data() + std::size_t{k} * (D + 1);
            for (int a = 0; a < D; ++a) {
                const double v = middle[a][rows.partners[k]];
                mean[a] += weight[0] * v;
                for (int b = 0; b < D; ++b) slope(a, b) += weight[1 + b] * v;
            }
        }
        // Without a gradient an element moves on as it did.
        if (rows.first[row] != rows.first[row + 1])
            for (int a = 0; a < D; ++a) velocity[a][i] = mean[a];
        put_tensor<D>(particles, soil_field::velocity_slope, i, slope);
    }
}

/// Axes along which a node's velocity is imposed.
std::array<bool, 3> held_axes(std::uint32_t held, std::span<const BoundaryCondition> conditions) {
    std::array<bool, 3> axes{};
    for (std::size_t c = 0; c < conditions.size() && held != 0; ++c)
        for (std::size_t a = 0; a < 3 && (held >> c & 1); ++a) axes[a] = axes[a] || conditions[c].held[a];
    return axes;
}

template <int D>
void deform_nodes_in(ParticleSet& particles, Cells which, const StepSettings& settings,
                     std::span<const BoundaryCondition> conditions, const StencilRows& rows,
                     const MovingMemory& memory) {
    const ElementColumns<D> of(particles);
    const StateColumns<D> columns(particles);
    const auto middle = sph::components<D>(particles, soil_field::middle_velocity);
    const auto position = sph::components_to_write<D>(particles, field::position);
    const auto displacement = sph::components_to_write<D>(particles, soil_field::displacement);
    const auto surface = sph::components_to_write<D>(particles, soil_field::surface);
    const std::uint8_t* body = particles.data(field::body);
    const double dt = settings.time_step;
    for (std::uint32_t row = rows.begin(which); row < rows.end(which); ++row) {
        const std::uint32_t i = rows.targets[row];
        Vector<D> seen = Vector<D>::Zero();
        Matrix<D> slope = Matrix<D>::Zero();
        const double volume = memory.volume[row];
        for (std::uint32_t k = rows.first[row]; k < rows.first[row + 1]; ++k) {
            const double* weight = rows.weights.data() + std::size_t{k} * (D + 1);
            const std::uint32_t e = rows.partners[k];
            const double share = weight[0] * of.volume[e] / volume;
            const Matrix<D> of_element = tensor_at<D>(of.slope, e);
            slope += share * of_element;
            seen +=
                share * (vector_at<D>(of.velocity, e) + of_element * Eigen::Map<const Vector<D>>(weight + 1));
        }
        const bool alone = !(volume > 0);
        const std::array<bool, 3> held = held_axes(particles.data(soil_field::conditions)[i], conditions);
        for (int a = 0; a < D; ++a) {
            const bool as_it_is = alone || held[static_cast<std::size_t>(a)];
            const double way = dt * (as_it_is ? middle[a][i] : seen[a]);
            position[a][i] += way;
            displacement[a][i] += way;
        }
        const Elasticity& elasticity = settings.materials[body[i]].elasticity;
        if (alone) {  // nothing is left to press on it
            columns.put_stress(i, {});
            continue;
        }
        if constexpr (D == 1) {
            const double gradient[1][1] = {{slope(0, 0)}};
            columns.add_elastic(i, elasticity, gradient, dt);
        } else {
            const Eigen::Matrix3d f = deformation<D>(slope, dt);
            columns.put_stress(i, hencky_stress(elasticity, columns.stress_at(i), f));
            const Vector<D> before = vector_at<D>(surface, i);
            if (before.isZero(0)) continue;
            const Matrix<D> plane = f.template topLeftCorner<D, D>();
            const Vector<D> after = plane.determinant() * (plane.inverse().transpose() * before);
            for (int a = 0; a < D; ++a) surface[a][i] = after[a];
        }
    }
}

template <int D>
void move_elements_in(ParticleSet& particles, const StencilRows& rows, double time_step) {
    const ElementColumns<D> of(particles);
    const auto position = sph::components_to_write<D>(particles, field::position);
    double* volume = particles.data(soil_field::volume);
    for (const std::uint32_t i : rows.targets) {
        const Matrix<D> slope = tensor_at<D>(of.slope, i);
        const Vector<D> way = time_step * (vector_at<D>(of.velocity, i) - slope * vector_at<D>(of.centre, i));
        for (int a = 0; a < D; ++a) position[a][i] += way[a];
        volume[i] *= deformation<D>(slope, time_step).determinant();
    }
}

}  // namespace

void list_targets(const ParticleSet& particles, const CellTable& table, Stencils& stencils) {
    const std::uint8_t* grid = particles.data(soil_field::grid);
    stencils.to_nodes.clear();
    stencils.to_elements.clear();
    for (const Cells which : {Cells::interior, Cells::boundary}) {
        table.for_each_own(which, [&](const CellEntry& cell, std::span<const Run>, std::size_t) {
            for (std::uint32_t i = cell.begin; i < cell.end; ++i)
                (grid[i] == node_grid ? stencils.to_nodes : stencils.to_elements).targets.push_back(i);
        });
        if (which == Cells::interior)
            for (StencilRows* rows : {&stencils.to_nodes, &stencils.to_elements})
                rows->interior = rows->targets.size();
    }
}

void centre_velocities(ParticleSet& particles, const Stencils& stencils) {
    for (int a = 0; a < particles.dimension(); ++a) {
        const double* after = particles.data(soil_field::velocity, a);
        double* middle = particles.data(soil_field::middle_velocity, a);
        stencils.for_each_node([&](std::uint32_t i) { middle[i] = 0.5 * (middle[i] + after[i]); });
    }
}

void measure_elements(ParticleSet& particles, Cells which, const StencilRows& rows) {
    sph::with_dimension(particles,
                        [&](auto dimension) { measure_elements_in<dimension()>(particles, which, rows); });
}

void deform_nodes(ParticleSet& particles, Cells which, const StepSettings& settings,
                  std::span<const BoundaryCondition> conditions, const StencilRows& rows,
                  const MovingMemory& memory) {
    sph::with_dimension(particles, [&](auto dimension) {
        deform_nodes_in<dimension()>(particles, which, settings, conditions, rows, memory);
    });
}

void move_elements(ParticleSet& particles, const StencilRows& rows, double time_step) {
    sph::with_dimension(particles,
                        [&](auto dimension) { move_elements_in<dimension()>(particles, rows, time_step); });
}

}  // namespace talus::soil
