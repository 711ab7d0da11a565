#pragma once
#include <array>

#include "domain/soil_fields.hpp"
#include "physics/soil/constitutive.hpp"
#include "physics/sph/pass_support.hpp"
#include "physics/sph/small_tensors.hpp"

namespace talus::soil {

/// Place of each stored component of a symmetric tensor among those of Tensor.
template <int D>
constexpr std::array<std::size_t, sph::symmetric_count<D>> tensor_places() {
    if constexpr (D == 1) return {0};
    if constexpr (D == 2) return {0, 1, 3};
    if constexpr (D == 3) return {0, 1, 2, 3, 4, 5};
}

/// Columns of velocity and stress; the lateral stress unless there are three dimensions.
template <int D>
struct StateColumns {
    static constexpr int stresses = sph::symmetric_count<D>;
    static constexpr bool has_lateral = D < 3;
    static constexpr int count = D + stresses + has_lateral;  ///< of all columns

    explicit StateColumns(ParticleSet& particles)
        : velocity(sph::components_to_write<D>(particles, soil_field::velocity)),
          stress(sph::components_to_write<stresses>(particles, soil_field::stress)),
          lateral(has_lateral ? particles.data(soil_field::lateral_stress) : nullptr) {}

    Tensor stress_at(std::size_t i) const {
        Tensor all{};
        for (std::size_t k = 0; k < stresses; ++k) all[tensor_places<D>()[k]] = stress[k][i];
        for (std::size_t axis = D; axis < 3; ++axis) all[axis] = lateral[i];
        return all;
    }
    void put_stress(std::size_t i, const Tensor& all) const {
        for (std::size_t k = 0; k < stresses; ++k) stress[k][i] = all[tensor_places<D>()[k]];
        if (has_lateral) lateral[i] = all[2];
    }
    /// Adds the elastic stress of a velocity gradient (rows: components of the velocity) for a time.
    void add_elastic(std::size_t i, const Elasticity& elasticity, const double (&gradient)[D][D],
                     double time) const {
        Tensor strain{};
        for (std::size_t k = 0; k < stresses; ++k) {
            const AxisPair axes = symmetric_axes(static_cast<int>(k), D);
            strain[tensor_places<D>()[k]] =
                0.5 * time * (gradient[axes.first][axes.second] + gradient[axes.second][axes.first]);
        }
        const Tensor added = elasticity.stress_of(strain);
        for (std::size_t k = 0; k < stresses; ++k) stress[k][i] += added[tensor_places<D>()[k]];
        if (has_lateral) lateral[i] += added[2];
    }
    std::array<const double*, count> all() const {
        std::array<const double*, count> columns{};
        for (std::size_t a = 0; a < D; ++a) columns[a] = velocity[a];
        for (std::size_t c = 0; c < stresses; ++c) columns[D + c] = stress[c];
        if (has_lateral) columns[count - 1] = lateral;
        return columns;
    }

    std::array<double*, D> velocity;
    std::array<double*, stresses> stress;
    double* lateral;
};

/// Gradient of the velocity and divergence of the stress, as partners add up.
template <int D>
struct FluxSums {
    double gradient[D][D] = {};
    double divergence[D] = {};

    void add_velocity(const double* weight, const std::array<double*, D>& velocity, std::uint32_t j) {
        for (int a = 0; a < D; ++a)
            for (int b = 0; b < D; ++b) gradient[a][b] += weight[b] * velocity[a][j];
    }
    void add_stress(const double* weight, const std::array<double*, sph::symmetric_count<D>>& stress,
                    std::uint32_t j) {
        for (int c = 0; c < sph::symmetric_count<D>; ++c) {
            const double s = stress[c][j];
            const AxisPair axes = symmetric_axes(c, D);
            divergence[axes.first] += weight[axes.second] * s;
            if (axes.first != axes.second) divergence[axes.second] += weight[axes.first] * s;
        }
    }
};

}  // namespace talus::soil
