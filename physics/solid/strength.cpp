#include "physics/solid/strength.hpp"

#include <type_traits>

namespace talus {

double shear_strength(const Strength& strength, double pressure, double internal_energy, double damage) {
    return std::visit([&](const auto& s) { return s.shear_strength(pressure, internal_energy, damage); },
                      strength);
}

double limit_factor(const Strength& strength, double sqrt_J2, double pressure, double internal_energy,
                    double damage) {
    const double limit = shear_strength(strength, pressure, internal_energy, damage);
    return sqrt_J2 > limit ? limit / sqrt_J2 : 1;
}

namespace {

template <int dimension, class Model>
void limit(const Model& model, const StrengthState& state, const StressColumns<double>& stress,
           std::span<const std::uint8_t> body, std::uint8_t which) {
    constexpr auto components = static_cast<std::size_t>(component_count(Shape::symmetric_tensor, dimension));
    const bool weakened = !state.damage.empty() && !Model::damage_scales_stress;
    for (std::size_t i = 0; i < body.size(); ++i) {
        if (body[i] != which) continue;
        const double J2 = second_invariant(deviator<dimension>(stress, i));
        const double most =
            model.shear_strength(state.pressure[i], state.internal_energy[i], weakened ? state.damage[i] : 0);
        if (J2 <= most * most) continue;
        const double factor = most / std::sqrt(J2);
        for (std::size_t c = 0; c < components; ++c) stress.component[c][i] *= factor;
    }
}

}  // namespace

void limit_stress(const Strength& strength, const StrengthState& state, StressColumns<double> stress,
                  std::span<const std::uint8_t> body, std::uint8_t which) {
    std::visit(
        [&](const auto& model) {
            if constexpr (std::is_same_v<std::decay_t<decltype(model)>, NoStrengthLimit>) return;
            if (stress.dimension == 1) limit<1>(model, state, stress, body, which);
            if (stress.dimension == 2) limit<2>(model, state, stress, body, which);
            if (stress.dimension == 3) limit<3>(model, state, stress, body, which);
        },
        strength);
}

void relieve_stress(const Strength& strength, std::span<const double> damage, std::span<double> pressure,
                    StressColumns<double> stress, std::span<const std::uint8_t> body, std::uint8_t which) {
    const bool scales = std::visit([](const auto& model) { return model.damage_scales_stress; }, strength);
    const auto components =
        static_cast<std::size_t>(component_count(Shape::symmetric_tensor, stress.dimension));
    for (std::size_t i = 0; i < body.size(); ++i) {
        if (body[i] != which || damage[i] == 0) continue;
        const double share = 1 - damage[i];
        if (pressure[i] < 0) pressure[i] *= share;
        for (std::size_t c = 0; scales && c < components; ++c) stress.component[c][i] *= share;
    }
}

}  // namespace talus
