#include "physics/solid/late_phase.hpp"

#include <stdexcept>

namespace talus {

namespace {

struct Softener {
    double stiffness;

    EquationOfState operator()(Tillotson eos) const {
        eos.a *= stiffness;
        eos.b *= stiffness;
        eos.A *= stiffness;
        eos.B *= stiffness;
        return eos;
    }
    EquationOfState operator()(LinearEquationOfState eos) const {
        eos.sound_speed *= std::sqrt(stiffness);
        return eos;
    }
    EquationOfState operator()(StiffenedGas eos) const {
        eos.gamma = 1 + stiffness * (eos.gamma - 1);
        eos.sound_speed *= std::sqrt(stiffness);
        return eos;
    }
    EquationOfState operator()(const IdealGas&) const {
        throw std::invalid_argument("an ideal gas has no stiffness of its own");
    }
};

constexpr double most_stretched = 0.9;  // of the reference density

/// Density between the bounds at which the pressure, which grows with it, is `wanted`.
template <class Eos>
double density_at(const Eos& eos, double wanted, double internal_energy, double low, double high) {
    constexpr int halvings = 60;
    for (int k = 0; k < halvings; ++k) {
        const double middle = 0.5 * (low + high);
        (eos.pressure(middle, internal_energy) < wanted ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

}  // namespace

Material softened(const Material& material, double stiffness) {
    Material softer = material;
    softer.eos = std::visit(Softener{stiffness}, material.eos);
    softer.shear_modulus *= stiffness;
    softer.bulk_modulus *= stiffness;
    softer.stiffness *= stiffness;
    return softer;
}

std::vector<std::size_t> keep_pressure(const EquationOfState& before, const EquationOfState& after,
                                       std::span<const double> internal_energy, std::span<double> density,
                                       std::span<const std::uint8_t> body, std::uint8_t which) {
    const double reference = reference_density(after), high = most_compressed * reference;
    std::vector<std::size_t> clipped;
    std::visit(
        [&](const auto& softer) {
            for (std::size_t i = 0; i < density.size(); ++i) {
                if (body[i] != which) continue;
                const double u = internal_energy[i], wanted = pressure(before, density[i], u);
                const double low = std::min(density[i], most_stretched * reference);
                if (!(softer.pressure(low, u) < wanted)) continue;
                if (softer.pressure(high, u) < wanted) clipped.push_back(i);
                density[i] = density_at(softer, wanted, u, low, high);
            }
        },
        after);
    return clipped;
}

}  // namespace talus
