#include "physics/solid/equation_of_state.hpp"

#include <limits>

namespace talus {

Tillotson::Slopes Tillotson::hot_slopes(double density, double internal_energy) const {
    const double u = internal_energy, eta = density / reference_density, mu = eta - 1, z = 1 / eta - 1;
    const double w = u / (E0 * eta * eta) + 1;
    const double fade = std::exp(-alpha * z * z), solid = A * std::exp(-beta * z);
    const double minus_dz_drho = 1 / (density * eta);
    const double bracket = b * density * u / w + solid * mu;
    const double bracket_slope = b * u / w + 2 * b * u * (w - 1) / (w * w) +
                                 solid * (1 / reference_density + mu * beta * minus_dz_drho);
    return {.P = a * density * u + bracket * fade,
            .dP_drho = a * u + (bracket_slope + bracket * 2 * alpha * z * minus_dz_drho) * fade,
            .dP_du = density * (a + b / (w * w) * fade)};
}

EosState Tillotson::blend(double density, double internal_energy) const {
    const double weight = (internal_energy - E_iv) / (E_cv - E_iv);
    const Slopes h = hot_slopes(density, internal_energy);
    double P = weight * h.P, dP_drho = weight * h.dP_drho, dP_du = weight * h.dP_du + h.P / (E_cv - E_iv);
    if (density >= cold_cut_ratio * reference_density) {
        // The cold form again, as slopes; kept apart from cold() so that the common path stays short.
        const double u = internal_energy, eta = density / reference_density, mu = eta - 1;
        const double w = u / (E0 * eta * eta) + 1, gruneisen = a + b / w;
        const double P_cold = gruneisen * density * u + A * mu + B * mu * mu;
        P += (1 - weight) * P_cold;
        dP_drho += (1 - weight) *
                   (gruneisen * u + 2 * b * u * (w - 1) / (w * w) + (A + 2 * B * mu) / reference_density);
        dP_du += (1 - weight) * density * (a + b / (w * w)) - P_cold / (E_cv - E_iv);
    }
    return {P, dP_drho + P / (density * density) * dP_du};
}

PressureAndSound evaluate(const EquationOfState& eos, double density, double internal_energy) {
    return std::visit(
        [&](const auto& e) -> PressureAndSound {
            const EosState s = e.state(density, internal_energy);
            return {s.pressure, sound_speed(e, s)};
        },
        eos);
}

double pressure(const EquationOfState& eos, double density, double internal_energy) {
    return std::visit([&](const auto& e) { return e.pressure(density, internal_energy); }, eos);
}

double reference_density(const EquationOfState& eos) {
    return std::visit([](const auto& e) { return e.reference_density; }, eos);
}

void evaluate(const EquationOfState& eos, std::span<const double> density,
              std::span<const double> internal_energy, std::span<double> pressure,
              std::span<double> sound_speed) {
    std::visit(
        [&](const auto& e) {
            for (std::size_t i = 0; i < density.size(); ++i) {
                const EosState s = e.state(density[i], internal_energy[i]);
                pressure[i] = s.pressure;
                sound_speed[i] = talus::sound_speed(e, s);
            }
        },
        eos);
}

void evaluate(const EquationOfState& eos, std::span<const double> density,
              std::span<const double> internal_energy, std::span<double> pressure,
              std::span<double> sound_speed, std::span<const std::uint8_t> body, std::uint8_t which) {
    std::visit(
        [&](const auto& e) {
            for (std::size_t i = 0; i < density.size(); ++i) {
                if (body[i] != which) continue;
                const EosState s = e.state(density[i], internal_energy[i]);
                pressure[i] = s.pressure;
                sound_speed[i] = talus::sound_speed(e, s);
            }
        },
        eos);
}

ScanResult scan(const Tillotson& eos, Interval density_ratio, Interval energy) {
    constexpr int densities = 400, energies = 200;
    ScanResult result;
    result.worst_c2 = std::numeric_limits<double>::infinity();
    const double floor = eos.least_sound_speed_squared();
    const double first = std::log(std::max(energy.low, 1e-3 * eos.E_iv));
    const double span = std::max(std::log(energy.high) - first, 0.0);
    for (int j = 0; j <= energies; ++j) {
        const double u = j == 0 ? energy.low : std::exp(first + span * (j - 1) / (energies - 1));
        for (int i = 0; i <= densities; ++i) {
            const double ratio = density_ratio.low + (density_ratio.high - density_ratio.low) * i / densities;
            const double density = ratio * eos.reference_density;
            const double c2 = eos.state(density, u).sound_speed_squared;
            ++result.points;
            result.floored += c2 < floor;
            if (c2 < 0) {
                ++result.imaginary;
                result.densest_imaginary = std::max(result.densest_imaginary, density);
            }
            if (c2 < result.worst_c2) {
                result.worst_c2 = c2;
                result.at_density = density;
                result.at_energy = u;
            }
        }
    }
    return result;
}

}  // namespace talus
