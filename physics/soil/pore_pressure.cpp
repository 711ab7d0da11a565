#include "physics/soil/pore_pressure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "comm/exact_sum.hpp"
#include "physics/soil/state_columns.hpp"

namespace talus::soil {

namespace {

constexpr int most_iterations = 20000;

/// k_w + dt/(2 rho) of a material.
double mobility(const Material& material, double time_step) {
    return material.permeability + 0.5 * time_step / material.density;
}

template <int D>
void flux_of_elements(ParticleSet& particles, const StencilRows& rows, Cells which,
                      const PorePressure::Settings& settings) {
    const double* guess = particles.data(soil_field::pressure_guess);
    const std::uint8_t* body = particles.data(field::body);
    const auto flux = sph::components_to_write<D>(particles, soil_field::pressure_flux);
    for (std::uint32_t row = rows.begin(which); row < rows.end(which); ++row) {
        const std::uint32_t i = rows.targets[row];
        double gradient[D] = {};
        const double* weight = rows.weights.data() + std::size_t{rows.first[row]} * (D + 1);
        for (std::uint32_t k = rows.first[row]; k < rows.first[row + 1]; ++k, weight += D + 1)
            for (int a = 0; a < D; ++a) gradient[a] += weight[1 + a] * guess[rows.partners[k]];
        const double factor = mobility(settings.materials[body[i]], settings.time_step);
        for (int a = 0; a < D; ++a) flux[a][i] = factor * gradient[a];
    }
}

/// Divergence at the nodes of one kind of rows, from a vector of elements: calls put(row, i, divergence).
template <int D, class Put>
void for_each_divergence(const StencilRows& rows, const std::array<const double*, D>& vector, Put&& put) {
    for (std::uint32_t row = 0; row < rows.targets.size(); ++row) {
        double divergence = 0;
        const double* weight = rows.weights.data() + std::size_t{rows.first[row]} * D;
        for (std::uint32_t k = rows.first[row]; k < rows.first[row + 1]; ++k, weight += D)
            for (int a = 0; a < D; ++a) divergence += weight[a] * vector[a][rows.partners[k]];
        put(row, rows.targets[row], divergence);
    }
}

}  // namespace

void add_pore_fields(ParticleSet& particles) {
    for (const FieldInfo* info :
         std::initializer_list<const FieldInfo*>{&soil_field::pore_pressure, &soil_field::volume,
                                                 &soil_field::pressure_guess, &soil_field::pressure_flux})
        particles.add(*info);
}

double PorePressure::dot(const Stencils& stencils, std::span<const double> a,
                         std::span<const double> b) const {
    ExactSum sum;
    stencils.for_each_node([&](std::uint32_t i) { sum.add(a[i] * b[i]); });
    ExactSum::all_reduce(comm_, std::span(&sum, 1));
    return sum.value();
}

/// The matrix times the guess, of free nodes.
void PorePressure::apply(ParticleSet& particles, const Stencils& stencils, const Settings& settings) {
    halo_.begin(particles, {&soil_field::pressure_guess});
    const double* guess = particles.data(soil_field::pressure_guess);
    const double* volume = particles.data(soil_field::volume);
    const std::uint8_t* body = particles.data(field::body);
    sph::with_dimension(particles, [&](auto dimension) {
        constexpr int D = dimension();
        flux_of_elements<D>(particles, stencils.to_elements, Cells::interior, settings);
        halo_.finish();
        flux_of_elements<D>(particles, stencils.to_elements, Cells::boundary, settings);
        halo_.begin(particles, {&soil_field::pressure_flux});
        halo_.finish();
        const auto flux = sph::components<D>(particles, soil_field::pressure_flux);
        for (const StencilRows* rows : {&stencils.to_nodes, &stencils.to_faces})
            for_each_divergence<D>(*rows, flux, [&](std::uint32_t, std::uint32_t i, double divergence) {
                const double storage = settings.materials[body[i]].storage / settings.time_step;
                product_[i] = volume[i] * (storage * guess[i] - divergence);
            });
    });
    const StencilRows& unseen = stencils.unseen;
    for (std::size_t row = 0; row < unseen.targets.size() && settings.stabilisation > 0; ++row) {
        const std::uint32_t i = unseen.targets[row];
        double found = 0;
        for (std::uint32_t k = unseen.first[row]; k < unseen.first[row + 1]; ++k)
            found += unseen.weights[k] * guess[unseen.partners[k]];
        product_[i] += volume[i] * settings.stabilisation *
                       mobility(settings.materials[body[i]], settings.time_step) /
                       (settings.spacing * settings.spacing) * found;
    }
    stencils.for_each_node([&](std::uint32_t i) {
        if (!is_free_[i]) product_[i] = 0;
    });
}

/// Diagonal of the matrix and the right-hand side.
void PorePressure::prepare(ParticleSet& particles, const Stencils& stencils, const Settings& settings) {
    const double* pressure = particles.data(soil_field::pore_pressure);
    const double* volume = particles.data(soil_field::volume);
    const std::uint8_t* body = particles.data(field::body);
    sph::with_dimension(particles, [&](auto dimension) {
        constexpr int D = dimension();
        const double element_volume = std::pow(settings.spacing, D);
        const auto velocity = sph::components<D>(particles, soil_field::velocity);
        for (const StencilRows* rows : {&stencils.to_nodes, &stencils.to_faces})
            for_each_divergence<D>(
                *rows, velocity, [&](std::uint32_t row, std::uint32_t i, double divergence) {
                    const Material& material = settings.materials[body[i]];
                    if (rows == &stencils.to_faces)
                        for (int a = 0; a < D; ++a)
                            divergence +=
                                stencils.own_weights[std::size_t{row} * D + static_cast<std::size_t>(a)] *
                                velocity[a][i];
                    const double storage = material.storage / settings.time_step;
                    right_[i] = volume[i] * (storage * pressure[i] - divergence);
                    double squares = 0;
                    const double* weight = rows->weights.data() + std::size_t{rows->first[row]} * D;
                    for (std::uint32_t k = 0; k < (rows->first[row + 1] - rows->first[row]) * D; ++k)
                        squares += weight[k] * weight[k];
                    diagonal_[i] = volume[i] * storage + mobility(material, settings.time_step) * volume[i] *
                                                             volume[i] / element_volume * squares;
                });
    });
}

void PorePressure::advance(ParticleSet& particles, const Stencils& stencils,
                           std::span<const std::uint32_t> imposed, const Settings& settings) {
    const std::size_t size = particles.size();
    for (std::vector<double>* values : {&residual_, &conditioned_, &product_, &diagonal_, &right_})
        values->assign(size, 0);
    is_free_.assign(size, 1);
    for (const std::uint32_t i : imposed) is_free_[i] = 0;
    prepare(particles, stencils, settings);
    double* pressure = particles.data(soil_field::pore_pressure);
    double* guess = particles.data(soil_field::pressure_guess);
    std::copy_n(pressure, size, guess);
    apply(particles, stencils, settings);
    guess = particles.data(soil_field::pressure_guess);
    stencils.for_each_node([&](std::uint32_t i) {
        residual_[i] = is_free_[i] ? right_[i] - product_[i] : 0;
        conditioned_[i] = residual_[i] / diagonal_[i];
        guess[i] = conditioned_[i];
        product_[i] = is_free_[i] ? right_[i] / diagonal_[i] : 0;
    });
    const double scale = std::max(dot(stencils, right_, product_), dot(stencils, residual_, conditioned_));
    double rest = dot(stencils, residual_, conditioned_);
    const double enough = settings.tolerance * settings.tolerance * scale;
    for (iterations_ = 0; rest > enough; ++iterations_) {
        if (iterations_ == most_iterations || !std::isfinite(rest))
            throw AgreedError(1, fmt::format("the pore pressure does not converge: after {} iterations the "
                                             "residual is {:.3g} of its first",
                                             iterations_, std::sqrt(rest / scale)));
        apply(particles, stencils, settings);
        const double step = rest / dot(stencils, {guess, size}, product_);
        stencils.for_each_node([&](std::uint32_t i) {
            pressure[i] += step * guess[i];
            residual_[i] -= step * product_[i];
            conditioned_[i] = residual_[i] / diagonal_[i];
        });
        const double before = rest;
        rest = dot(stencils, residual_, conditioned_);
        stencils.for_each_node(
            [&](std::uint32_t i) { guess[i] = conditioned_[i] + rest / before * guess[i]; });
    }
}

namespace {

template <int D>
void correct_elements_in(ParticleSet& particles, const StencilRows& rows,
                         const PorePressure::Settings& settings) {
    const StateColumns<D> columns(particles);
    const double* pressure = particles.data(soil_field::pore_pressure);
    const std::uint8_t* body = particles.data(field::body);
    for (std::uint32_t row = 0; row < rows.targets.size(); ++row) {
        const std::uint32_t i = rows.targets[row];
        double value = 0, gradient[D] = {};
        const double* weight = rows.weights.data() + std::size_t{rows.first[row]} * (D + 1);
        for (std::uint32_t k = rows.first[row]; k < rows.first[row + 1]; ++k, weight += D + 1) {
            const double p = pressure[rows.partners[k]];
            value += weight[0] * p;
            for (int a = 0; a < D; ++a) gradient[a] += weight[1 + a] * p;
        }
        const double factor = 0.5 * settings.time_step / settings.materials[body[i]].density;
        for (int a = 0; a < D; ++a) {
            columns.velocity[a][i] -= factor * gradient[a];
            columns.stress[a][i] -= value;
        }
        if (D < 3) columns.lateral[i] -= value;
    }
}

}  // namespace

void PorePressure::correct_elements(ParticleSet& particles, const StencilRows& rows,
                                    const Settings& settings) {
    sph::with_dimension(particles,
                        [&](auto dimension) { correct_elements_in<dimension()>(particles, rows, settings); });
}

}  // namespace talus::soil
