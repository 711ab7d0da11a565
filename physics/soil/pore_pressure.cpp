#include "physics/soil/pore_pressure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "comm/exact_sum.hpp"
#include "physics/soil/node_density.hpp"
#include "physics/soil/state_columns.hpp"

namespace talus::soil {

namespace {

constexpr int most_iterations = 20000;

/// k_w + dt/(2 rho) of a material.
double mobility(const Material& material, double time_step) {
    return material.permeability + 0.5 * time_step / material.density;
}

/// Flux of elements, and in the place of their guess the mean of the nodes' guesses.
template <int D>
void flux_of_elements(ParticleSet& particles, const StencilRows& rows, Cells which,
                      const PorePressure::Settings& settings) {
    double* guess = particles.data(soil_field::pressure_guess);
    const std::uint8_t* body = particles.data(field::body);
    const auto flux = sph::components_to_write<D>(particles, soil_field::pressure_flux);
    for (std::uint32_t row = rows.begin(which); row < rows.end(which); ++row) {
        const std::uint32_t i = rows.targets[row];
        double value = 0, gradient[D] = {};
        const double* weight = rows.weights.data() + std::size_t{rows.first[row]} * (D + 1);
        for (std::uint32_t k = rows.first[row]; k < rows.first[row + 1]; ++k, weight += D + 1) {
            value += weight[0] * guess[rows.partners[k]];
            for (int a = 0; a < D; ++a) gradient[a] += weight[1 + a] * guess[rows.partners[k]];
        }
        guess[i] = value;
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

void add_pore_fields(ParticleSet& particles, bool with_free_faces) {
    if (with_free_faces) particles.add(soil_field::earlier_pore_pressure);
    for (const FieldInfo* info :
         std::initializer_list<const FieldInfo*>{&soil_field::pore_pressure, &soil_field::volume,
                                                 &soil_field::pressure_guess, &soil_field::pressure_flux})
        particles.add(*info);
}

void remember_pore_pressures(ParticleSet& particles) {
    const auto now = std::as_const(particles).own(soil_field::pore_pressure);
    std::copy(now.begin(), now.end(), particles.data(soil_field::earlier_pore_pressure));
}

double PorePressure::dot(const Stencils& stencils, std::span<const double> a,
                         std::span<const double> b) const {
    ExactSum sum;
    stencils.for_each_node([&](std::uint32_t i) { sum.add(a[i] * b[i]); });
    ExactSum::all_reduce(comm_, std::span(&sum, 1));
    return sum.value();
}

namespace {

/// Mean over the elements around nodes of their mobility times what the linear fit there does not see.
template <int D>
void add_unseen(const ParticleSet& particles, const StencilRows& rows, const PorePressure::Settings& settings,
                std::vector<double>& product) {
    const double* guess = particles.data(soil_field::pressure_guess);
    const double* volume = particles.data(soil_field::volume);
    const std::uint8_t* body = particles.data(field::body);
    const auto flux = sph::components<D>(particles, soil_field::pressure_flux);
    const auto position = sph::components<D>(particles, field::position);
    for (std::uint32_t row = 0; row < rows.targets.size(); ++row) {
        const std::uint32_t i = rows.targets[row];
        double found = 0;
        for (std::uint32_t k = rows.first[row]; k < rows.first[row + 1]; ++k) {
            const std::uint32_t e = rows.partners[k];
            found += mobility(settings.materials[body[e]], settings.time_step) * (guess[i] - guess[e]);
            for (int a = 0; a < D; ++a) found -= flux[a][e] * (position[a][i] - position[a][e]);
        }
        product[i] += volume[i] * settings.stabilisation / (settings.spacing * settings.spacing) * found /
                      (rows.first[row + 1] - rows.first[row]);
    }
}

}  // namespace

/// The matrix times the guess, of free nodes.
void PorePressure::apply(ParticleSet& particles, const Stencils& stencils, const Settings& settings) {
    halo_.begin(particles, {&soil_field::pressure_guess});
    const std::uint8_t* body = particles.data(field::body);
    sph::with_dimension(particles, [&](auto dimension) {
        constexpr int D = dimension();
        flux_of_elements<D>(particles, stencils.to_elements, Cells::interior, settings);
        halo_.finish();
        flux_of_elements<D>(particles, stencils.to_elements, Cells::boundary, settings);
        halo_.begin(particles, {&soil_field::pressure_flux, &soil_field::pressure_guess});
        halo_.finish();
        const double* guess = particles.data(soil_field::pressure_guess);
        const double* volume = particles.data(soil_field::volume);
        const auto flux = sph::components<D>(particles, soil_field::pressure_flux);
        for (const StencilRows* rows : {&stencils.to_nodes, &stencils.to_faces}) {
            for_each_divergence<D>(*rows, flux, [&](std::uint32_t, std::uint32_t i, double divergence) {
                const double storage = settings.materials[body[i]].storage / settings.time_step;
                product_[i] = volume[i] * (storage * guess[i] - divergence);
            });
            if (settings.stabilisation > 0) add_unseen<D>(particles, *rows, settings, product_);
        }
        if (!settings.faces.any) return;
        press_faces(particles, stencils, settings.faces, settings.materials, settings.time_step);
        halo_.begin(particles, {&soil_field::pressure_flux});
        halo_.finish();
        const auto pressed = sph::components<D>(particles, soil_field::pressure_flux);
        for (std::uint32_t row = 0; row < stencils.to_faces.targets.size(); ++row) {
            const std::uint32_t i = stencils.to_faces.targets[row];
            by_faces_[i] = is_free_[i] ? volume[i] * divergence_of_face<D>(pressed, stencils, row) : 0;
            product_[i] -= (1 + settings.faces.extra_yielding) * by_faces_[i];
        }
    });
    stencils.for_each_node([&](std::uint32_t i) {
        if (!is_free_[i]) product_[i] = 0;
    });
}

/// Diagonal of the matrix and the right-hand side.
void PorePressure::prepare(ParticleSet& particles, const Stencils& stencils, const Settings& settings) {
    const FreeFaces& faces = settings.faces;
    if (faces.any) {
        predict_face_velocities(particles, stencils, faces, settings.materials, settings.time_step);
        halo_.begin(particles, {&soil_field::pressure_flux});
        halo_.finish();
    }
    const double* pressure = particles.data(soil_field::pore_pressure);
    const double* volume = particles.data(soil_field::volume);
    const std::uint8_t* body = particles.data(field::body);
    sph::with_dimension(particles, [&](auto dimension) {
        constexpr int D = dimension(), corners = 1 << D;
        const double element_volume = std::pow(settings.spacing, D);
        const double unseen =
            settings.stabilisation / (settings.spacing * settings.spacing) * (corners - 1 - D) / corners;
        const NodeDensity density(particles, settings.materials);
        const auto velocity = sph::components<D>(particles, soil_field::velocity),
                   ahead = sph::components<D>(particles, soil_field::pressure_flux);
        for (const StencilRows* rows : {&stencils.to_nodes, &stencils.to_faces})
            for_each_divergence<D>(
                *rows, velocity, [&](std::uint32_t row, std::uint32_t i, double divergence) {
                    const double storage = settings.materials[body[i]].storage / settings.time_step;
                    double squares = 0, mobilities = 0, own_squares = 0;
                    const double* weight = rows->weights.data() + std::size_t{rows->first[row]} * D;
                    for (std::uint32_t k = rows->first[row]; k < rows->first[row + 1]; ++k, weight += D) {
                        const double factor =
                            mobility(settings.materials[body[rows->partners[k]]], settings.time_step);
                        mobilities += factor / (rows->first[row + 1] - rows->first[row]);
                        for (int a = 0; a < D; ++a) squares += factor * weight[a] * weight[a];
                    }
                    if (rows == &stencils.to_faces) {
                        const double* own = stencils.own_weights.data() + std::size_t{row} * D;
                        if (faces.any) divergence += divergence_of_face<D>(ahead, stencils, row);
                        for (std::size_t a = 0; a < D; ++a) {
                            if (!faces.any) divergence += own[a] * velocity[a][i];
                            if (faces.any && (faces.free_axes[row] >> a & 1)) own_squares += own[a] * own[a];
                        }
                    }
                    right_[i] = volume[i] * (storage * pressure[i] - divergence);
                    diagonal_[i] =
                        volume[i] * (storage + volume[i] / element_volume * squares + unseen * mobilities +
                                     (1 + faces.extra_yielding) * 0.5 * settings.time_step / density[i] *
                                         own_squares / corners);
                });
    });
}

void PorePressure::advance(ParticleSet& particles, const Stencils& stencils,
                           std::span<const std::uint32_t> imposed, const Settings& settings) {
    const std::size_t size = particles.size();
    for (std::vector<double>* values :
         {&residual_, &conditioned_, &product_, &diagonal_, &right_, &by_faces_})
        values->assign(size, 0);
    is_free_.assign(size, 1);
    for (const std::uint32_t i : imposed) is_free_[i] = 0;
    prepare(particles, stencils, settings);
    if (settings.faces.extra_yielding > 0) extrapolate(particles, stencils);
    double* pressure = particles.data(soil_field::pore_pressure);
    double* guess = particles.data(soil_field::pressure_guess);
    std::copy_n(pressure, size, guess);
    apply(particles, stencils, settings);
    guess = particles.data(soil_field::pressure_guess);
    stencils.for_each_node([&](std::uint32_t i) {
        right_[i] -= settings.faces.extra_yielding * by_faces_[i];  // beyond the guess of the start alone
        residual_[i] = is_free_[i] ? right_[i] - product_[i] : 0;
        conditioned_[i] = residual_[i] / diagonal_[i];
        guess[i] = conditioned_[i];
        product_[i] = is_free_[i] ? right_[i] / diagonal_[i] : 0;
    });
    const double scale = std::max(dot(stencils, right_, product_), dot(stencils, residual_, conditioned_));
    const double enough = settings.tolerance * settings.tolerance * scale;
    iterations_ = 0;
    if (settings.faces.any)
        stabilised_biconjugate_gradients(particles, stencils, settings, enough);
    else
        conjugate_gradients(particles, stencils, settings, enough);
}

/// The pressure as it goes on from the last two steps, where none is imposed: the guess to start from.
void PorePressure::extrapolate(ParticleSet& particles, const Stencils& stencils) const {
    double* pressure = particles.data(soil_field::pore_pressure);
    double* earlier = particles.data(soil_field::earlier_pore_pressure);
    stencils.for_each_node([&](std::uint32_t i) {
        const double now = pressure[i];
        if (is_free_[i]) pressure[i] = 2 * now - earlier[i];
        earlier[i] = now;
    });
}

void PorePressure::refuse_unless_converging(double rest, double enough, const Settings& settings) const {
    if (iterations_ < most_iterations && std::isfinite(rest)) return;
    throw AgreedError(1, fmt::format("the pore pressure does not converge: after {} iterations the "
                                     "residual is {:.3g} of its first",
                                     iterations_, settings.tolerance * std::sqrt(rest / enough)));
}

void PorePressure::conjugate_gradients(ParticleSet& particles, const Stencils& stencils,
                                       const Settings& settings, double enough) {
    double* pressure = particles.data(soil_field::pore_pressure);
    double* guess = particles.data(soil_field::pressure_guess);
    double rest = dot(stencils, residual_, conditioned_);
    for (; rest > enough; ++iterations_) {
        refuse_unless_converging(rest, enough, settings);
        apply(particles, stencils, settings);
        const double step = rest / dot(stencils, {guess, particles.size()}, product_);
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

void PorePressure::stabilised_biconjugate_gradients(ParticleSet& particles, const Stencils& stencils,
                                                    const Settings& settings, double enough) {
    const std::size_t size = particles.size();
    double* pressure = particles.data(soil_field::pore_pressure);
    double* guess = particles.data(soil_field::pressure_guess);
    // Products of residuals are weighted by the inverse of the diagonal.
    const std::vector<double> shadow = conditioned_;
    std::vector<double> direction = residual_, image(size, 0);
    double rest = dot(stencils, residual_, conditioned_), along = rest;
    for (; rest > enough; ++iterations_) {
        refuse_unless_converging(rest, enough, settings);
        stencils.for_each_node([&](std::uint32_t i) { guess[i] = direction[i] / diagonal_[i]; });
        apply(particles, stencils, settings);
        image = product_;
        const double step = along / dot(stencils, shadow, image);
        stencils.for_each_node([&](std::uint32_t i) {
            pressure[i] += step * guess[i];
            residual_[i] -= step * image[i];
            guess[i] = residual_[i] / diagonal_[i];
        });
        apply(particles, stencils, settings);
        stencils.for_each_node([&](std::uint32_t i) { conditioned_[i] = product_[i] / diagonal_[i]; });
        const double square = dot(stencils, product_, conditioned_);
        const double turn = square > 0 ? dot(stencils, residual_, conditioned_) / square : 0;
        stencils.for_each_node([&](std::uint32_t i) {
            pressure[i] += turn * guess[i];
            residual_[i] -= turn * product_[i];
            conditioned_[i] = residual_[i] / diagonal_[i];
        });
        rest = dot(stencils, residual_, conditioned_);
        if (rest <= enough) continue;
        const double before = along;
        along = dot(stencils, shadow, residual_);
        const double keep = along / before * step / turn;
        stencils.for_each_node(
            [&](std::uint32_t i) { direction[i] = residual_[i] + keep * (direction[i] - turn * image[i]); });
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
