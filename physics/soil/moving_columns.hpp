#pragma once
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "domain/soil_fields.hpp"
#include "physics/soil/state_columns.hpp"

// Values of moving grids as vectors and matrices.
namespace talus::soil {

template <int D>
using Vector = Eigen::Matrix<double, D, 1>;
template <int D>
using Matrix = Eigen::Matrix<double, D, D>;

template <int D, class T>
Vector<D> vector_at(const std::array<T*, D>& columns, std::size_t i) {
    Vector<D> found;
    for (int a = 0; a < D; ++a) found[a] = columns[static_cast<std::size_t>(a)][i];
    return found;
}

template <int D>
Matrix<D> symmetric_at(const std::array<const double*, sph::symmetric_count<D>>& columns, std::size_t i) {
    Matrix<D> found;
    for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b)
            found(a, b) = columns[static_cast<std::size_t>(sph::symmetric_index<D>(a, b))][i];
    return found;
}

template <int D>
Matrix<D> tensor_at(const std::array<const double*, D * D>& columns, std::size_t i) {
    Matrix<D> found;
    for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) found(a, b) = columns[static_cast<std::size_t>(a * D + b)][i];
    return found;
}

template <int D>
void put_tensor(ParticleSet& particles, const Field<double>& field, std::size_t i, const Matrix<D>& value) {
    for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) particles.data(field, a * D + b)[i] = value(a, b);
}

/// Columns of a stress in StateColumns, the lateral one among them.
template <int D>
inline constexpr int stress_count = sph::symmetric_count<D> + (D < 3 ? 1 : 0);

template <int D>
std::array<double*, stress_count<D>> stress_columns_of(const StateColumns<D>& columns) {
    std::array<double*, stress_count<D>> all{};
    std::copy(columns.stress.begin(), columns.stress.end(), all.begin());
    if (D < 3) all.back() = columns.lateral;
    return all;
}

/// Linear fits of the stress, value and slopes, in elements; empty unless it is smoothed.
template <int D>
std::vector<double*> stress_fits(ParticleSet& particles) {
    std::vector<double*> fits;
    if (!particles.has(soil_field::stress_fit)) return fits;
    for (int c = 0; c < (1 + D) * stress_count<D>; ++c)
        fits.push_back(particles.data(soil_field::stress_fit, c));
    return fits;
}

/// The increment of the deformation gradient that a velocity gradient makes in a time.
template <int D>
Eigen::Matrix3d deformation(const Matrix<D>& gradient, double time) {
    Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
    f.template topLeftCorner<D, D>() += time * gradient;
    return f;
}

/// What elements hold for nodes.
template <int D>
struct ElementColumns {
    explicit ElementColumns(const ParticleSet& particles)
        : position(sph::components<D>(particles, field::position)),
          velocity(sph::components<D>(particles, soil_field::velocity)),
          stress(sph::components<D * D>(particles, soil_field::nominal_stress)),
          slope(sph::components<D * D>(particles, soil_field::velocity_slope)),
          centre(sph::components<D>(particles, soil_field::fit_centre)),
          inverse(sph::components<sph::symmetric_count<D>>(particles, soil_field::fit_inverse)),
          weight(particles.data(soil_field::fit_weight)),
          volume(particles.data(soil_field::volume)),
          mass(particles.data(field::mass)),
          h(particles.data(field::smoothing_length)),
          grid(particles.data(soil_field::grid)) {}

    std::array<const double*, D> position, velocity;
    std::array<const double*, D * D> stress, slope;
    std::array<const double*, D> centre;
    std::array<const double*, sph::symmetric_count<D>> inverse;
    const double *weight, *volume, *mass, *h;
    const std::uint8_t* grid;
};

}  // namespace talus::soil
