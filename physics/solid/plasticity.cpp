#include "physics/solid/plasticity.hpp"

#include <cmath>
#include <limits>
#include <type_traits>

namespace talus {

Cone cone(ConeMatch match, double cohesion, double friction_angle, double dilation_angle) {
    return cone_of_slopes(match, cohesion, std::tan(friction_angle), std::tan(dilation_angle));
}

Cone cone_of_slopes(ConeMatch match, double cohesion, double friction_slope, double dilation_slope) {
    const double cosine = 1 / std::sqrt(1 + friction_slope * friction_slope);
    const double s = friction_slope * cosine, c = cohesion * cosine;
    const double flow = dilation_slope / std::sqrt(1 + dilation_slope * dilation_slope);
    if (match == ConeMatch::plane_strain) {
        const double b = flow / std::sqrt(9 + 3 * flow * flow);
        const double share = 1 / (std::sqrt(1 - 3 * b * b) + b * s);
        return {.friction = s * share, .cohesion = c * share, .dilation = 3 * b};
    }
    const double sign = match == ConeMatch::compression ? -1 : 1, root3 = std::sqrt(3.0);
    return {.friction = 6 * s / (root3 * (3 + sign * s)),
            .cohesion = 6 * c / (root3 * (3 + sign * s)),
            .dilation = 6 * flow / (root3 * (3 + sign * flow))};
}

Returned returned(const DruckerPrager& model, const Elasticity& elastic, const Invariants& trial,
                  double strain) {
    const Cone cone = model.cone_at(strain);
    const double apex =
        cone.friction > 0 ? cone.cohesion / cone.friction : std::numeric_limits<double>::infinity();
    const double least = -std::min(model.tensile_strength, apex);  // pressure
    const double K = elastic.bulk_modulus, G = elastic.shear_modulus;
    const double tangent = K + trial.pressure;  // dp per volume strain
    Returned result{.state = trial};
    Invariants& now = result.state;
    const double excess = trial.shear - cone.cohesion - cone.friction * trial.pressure;
    if (excess > 0) {
        const double flow = excess / (G + tangent * cone.friction * cone.dilation);
        const double lambda = std::min(flow, trial.shear / G);  // no farther than to the axis
        now = {trial.pressure + tangent * cone.dilation * lambda, std::max(0.0, trial.shear - G * lambda)};
    }
    result.volume_strain = std::log((K + now.pressure) / (K + trial.pressure));
    if (now.pressure < least) {
        result.gap = std::log((K + least) / (K + now.pressure));
        now = {least, std::min(trial.shear, std::max(0.0, cone.cohesion + cone.friction * least))};
    }
    result.shear_strain = (trial.shear - now.shear) / G;
    return result;
}

Returned returned(const GranularFlow& model, const Elasticity& elastic, const Invariants& trial,
                  double elapsed) {
    const double K = elastic.bulk_modulus;
    if (!(trial.pressure > 0)) return {.state = {0, 0}, .gap = std::log(K / (K + trial.pressure))};
    const double p = trial.pressure, slow = model.friction_static * p, fast = model.friction_limit * p;
    if (trial.shear <= slow) return {.state = trial};
    // rate = xi sqrt(p) (tau - slow)/(fast - tau), trial - tau = G elapsed rate
    const double xi = model.inertial_number / (model.grain_diameter * std::sqrt(model.grain_density));
    const double a = xi * elastic.shear_modulus * elapsed * std::sqrt(p);
    const double sum = fast + trial.shear + a, product = fast * trial.shear + slow * a;
    const double tau = 2 * product / (sum + std::sqrt(std::max(0.0, sum * sum - 4 * product)));
    return {.state = {p, tau}, .shear_strain = (trial.shear - tau) / elastic.shear_modulus};
}

namespace {

template <int dimension, class Model>
void return_all(const Model& model, const Elasticity& elastic, const PlasticState& state, double elapsed,
                bool keep_strains, std::span<double> pressure, std::span<const std::uint8_t> body,
                std::uint8_t which) {
    constexpr auto components = static_cast<std::size_t>(component_count(Shape::symmetric_tensor, dimension));
    const bool opens = !state.volume_strain.empty(), softens = !state.shear_strain.empty();
    for (std::size_t i = 0; i < body.size(); ++i) {
        if (body[i] != which) continue;
        double density = state.density[i];
        if (opens) density *= std::exp(state.volume_strain[i]);
        const Invariants trial{elastic.bulk_modulus * (density / elastic.reference_density - 1),
                               std::sqrt(second_invariant(deviator<dimension>(state.stress, i)))};
        Returned end;
        if constexpr (std::is_same_v<Model, GranularFlow>)
            end = returned(model, elastic, trial, elapsed);
        else
            end = returned(model, elastic, trial, softens ? state.shear_strain[i] : 0);
        if (!pressure.empty()) pressure[i] = end.state.pressure;
        if (end.state.shear < trial.shear) {
            const double factor = end.state.shear / trial.shear;
            for (std::size_t c = 0; c < components; ++c) state.stress.component[c][i] *= factor;
        }
        if (model.forgets_gaps && end.gap > 0) state.density[i] *= std::exp(end.gap);
        if (!keep_strains) continue;
        if (opens) state.volume_strain[i] += end.volume_strain;
        if (softens) state.shear_strain[i] += end.shear_strain;
    }
}

}  // namespace

void return_stress(const Plasticity& model, const Elasticity& elastic, const PlasticState& state,
                   double elapsed, bool keep_strains, std::span<double> pressure,
                   std::span<const std::uint8_t> body, std::uint8_t which) {
    std::visit(
        [&](const auto& of) {
            if (state.stress.dimension == 1)
                return_all<1>(of, elastic, state, elapsed, keep_strains, pressure, body, which);
            if (state.stress.dimension == 2)
                return_all<2>(of, elastic, state, elapsed, keep_strains, pressure, body, which);
            if (state.stress.dimension == 3)
                return_all<3>(of, elastic, state, elapsed, keep_strains, pressure, body, which);
        },
        model);
}

}  // namespace talus
