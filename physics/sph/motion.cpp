#include "physics/sph/motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "physics/solid/stress_update.hpp"
#include "physics/sph/pass_support.hpp"

namespace talus::sph {

namespace {

/// Specific internal energy after `time`, the velocity before that being v: total work of the pair forces
/// less the kinetic part. `a` is the acceleration by them, `total` that by all forces.
template <int D>
double advanced_energy(double energy, double power, const std::array<double, D>& v,
                       const std::array<double, D>& a, const std::array<double, D>& total, double time) {
    double kinetic = 0;
    for (int d = 0; d < D; ++d) kinetic += a[d] * (v[d] + 0.5 * time * total[d]);
    return energy + time * (power - kinetic);
}

template <int D>
double divergence(const std::array<const double*, D * D>& gradient, std::size_t i) {
    double sum = 0;
    for (int d = 0; d < D; ++d) sum += gradient[d * D + d][i];
    return sum;
}

/// The least density that the continuity equation may lead to [kg/m3]: a lone particle's own share of the
/// density summed with the Gaussian that ends at twice its h. Gradients over a handful of partners mean
/// little, and matter all but without density next to denser matter would be thrown about by it (V_ij^2 grows
/// as 1/rho^2). The code of K. Sugiura et al., Astron. Astrophys. 620 (2018) A167, stops at 200 kg/m3 for the
/// same reason.
template <int D>
double least_density(double mass, double range) {
    double volume = 1;
    for (int d = 0; d < D; ++d) volume *= 0.5 * std::sqrt(std::numbers::pi) * range;
    return mass / volume;
}

/// Writes the state moved by `time` into the given fields, which may be those of the state itself.
template <int D>
void advance(ParticleSet& particles, const BodyConstants& bodies, double kernel_support, double time,
             const Field<double>& to_velocity, const Field<double>& to_energy,
             const Field<double>& to_density, const Field<double>& to_stress) {
    const auto v = components<D>(particles, field::velocity),
               a = components<D>(particles, field::acceleration);
    const double *power = particles.data(field::specific_power),
                 *energy = particles.data(field::internal_energy);
    const auto new_v = components_to_write<D>(particles, to_velocity);
    double* new_energy = particles.data(to_energy);
    const bool has_gravity = particles.has(field::gravity_acceleration);
    std::array<const double*, D> g{};
    if (has_gravity) g = components<D>(particles, field::gravity_acceleration);
    const bool falls = !bodies.gravity.empty();
    const std::uint8_t* body = particles.data(field::body);
    for (std::size_t i = 0; i < particles.size(); ++i) {
        std::array<double, D> v_i, a_i, total_i;
        for (int d = 0; d < D; ++d) {
            v_i[d] = v[d][i];
            a_i[d] = a[d][i];
            total_i[d] = has_gravity ? a_i[d] + g[d][i] : a_i[d];
        }
        if (falls)
            for (int d = 0; d < D; ++d) total_i[d] += bodies.gravity[body[i]][d];
        new_energy[i] = advanced_energy<D>(energy[i], power[i], v_i, a_i, total_i, time);
        for (int d = 0; d < D; ++d) new_v[d][i] = v_i[d] + time * total_i[d];
    }

    if (!particles.has(field::density)) return;
    const auto gradient = components<D * D>(particles, field::velocity_gradient);
    const double* density = particles.data(field::density);
    double* new_density = particles.data(to_density);
    const double *mass = particles.data(field::mass), *h = particles.data(field::smoothing_length);
    for (std::size_t i = 0; i < particles.size(); ++i)
        new_density[i] = std::max(density[i] * std::exp(-divergence<D>(gradient, i) * time),
                                  least_density<D>(mass[i], kernel_support * h[i]));

    if (!particles.has(field::deviatoric_stress)) return;
    constexpr int N = symmetric_count<D>;
    const auto stress = components<N>(particles, field::deviatoric_stress);
    const auto new_stress = components_to_write<N>(particles, to_stress);
    for (std::size_t i = 0; i < particles.size(); ++i) {
        std::array<double, N> s_i;
        std::array<double, D * D> gradient_i;
        for (int c = 0; c < N; ++c) s_i[c] = stress[c][i];
        for (int c = 0; c < D * D; ++c) gradient_i[c] = gradient[c][i];
        const auto advanced = advanced_stress<D>(s_i, gradient_i, bodies.shear_modulus[body[i]], time);
        for (int c = 0; c < N; ++c) new_stress[c][i] = advanced[c];
    }
}

}  // namespace

void kick(ParticleSet& particles, const BodyConstants& bodies, const Settings& settings, double time) {
    with_dimension(particles, [&](auto dimension) {
        advance<dimension>(particles, bodies, settings.kernel_support(), time, field::velocity,
                           field::internal_energy, field::density, field::deviatoric_stress);
    });
}

void predict(ParticleSet& particles, const BodyConstants& bodies, const Settings& settings, double time) {
    with_dimension(particles, [&](auto dimension) {
        advance<dimension>(particles, bodies, settings.kernel_support(), time, field::predicted_velocity,
                           field::predicted_energy, field::predicted_density, field::predicted_stress);
    });
}

void drift(ParticleSet& particles, double time) {
    for (int axis = 0; axis < particles.dimension(); ++axis) {
        double* x = particles.data(field::position, axis);
        const double* v = particles.data(field::velocity, axis);
        for (std::size_t i = 0; i < particles.size(); ++i) x[i] += v[i] * time;
    }
}

namespace {

template <int D>
StepLimit stable_step(const ParticleSet& particles, const BodyConstants& bodies, const Settings& settings) {
    const double* c = particles.data(field::sound_speed);
    const double* density = particles.data(field::predicted_density);
    const double* h = particles.data(field::smoothing_length);
    const std::uint8_t* body = particles.data(field::body);
    const auto a = components<D>(particles, field::acceleration);
    const bool has_gradient = particles.has(field::velocity_gradient);
    std::array<const double*, D * D> gradient{};
    if (has_gradient) gradient = components<D * D>(particles, field::velocity_gradient);
    const double* viscous_speed =
        settings.formulation == Formulation::standard ? particles.data(field::viscous_speed) : nullptr;
    double courant = std::numeric_limits<double>::infinity(), accelerated = courant;
    std::size_t courant_at = 0, accelerated_at = 0;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        double acceleration2 = 0;
        for (int d = 0; d < D; ++d) acceleration2 += a[d][i] * a[d][i];
        const double modulus = bodies.shear_modulus[body[i]];
        const double elastic = modulus > 0 ? 4.0 / 3 * modulus / density[i] : 0;
        const double speed = std::sqrt(c[i] * c[i] + elastic) + (viscous_speed ? 0.6 * viscous_speed[i] : 0) +
                             (has_gradient ? h[i] * std::abs(divergence<D>(gradient, i)) : 0);
        const double by_speed = h[i] / speed, by_acceleration = std::sqrt(h[i] / std::sqrt(acceleration2));
        if (by_speed < courant) {
            courant = by_speed;
            courant_at = i;
        }
        if (by_acceleration < accelerated) {
            accelerated = by_acceleration;
            accelerated_at = i;
        }
    }
    const std::uint64_t* id = particles.data(field::id);
    if (particles.size() == 0) return {courant, 0, "no particles"};
    if (courant < accelerated) return {settings.courant * courant, id[courant_at], "sound"};
    return {settings.courant * accelerated, id[accelerated_at], "acceleration"};
}

}  // namespace

StepLimit stable_time_step(const ParticleSet& particles, const BodyConstants& bodies,
                           const Settings& settings) {
    StepLimit limit{};
    with_dimension(particles,
                   [&](auto dimension) { limit = stable_step<dimension>(particles, bodies, settings); });
    return limit;
}

}  // namespace talus::sph
