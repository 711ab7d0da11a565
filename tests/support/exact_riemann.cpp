#include "tests/support/exact_riemann.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace talus::reference {

namespace {
GasState mirrored(GasState state) { return {state.density, -state.velocity, state.pressure}; }
}  // namespace

ExactRiemann::ExactRiemann(GasState left, GasState right, double gamma)
    : left_(left), right_(right), gamma_(gamma) {
    if (!(left.density > 0 && left.pressure > 0 && right.density > 0 && right.pressure > 0 && gamma > 1))
        throw std::invalid_argument("Riemann problem: densities and pressures > 0 and gamma > 1 are needed");
    const double jump = right.velocity - left.velocity;
    if (2 * (sound_speed(left) + sound_speed(right)) / (gamma - 1) <= jump)
        throw std::invalid_argument("Riemann problem: the gases part faster than they can expand (vacuum)");

    // f(p) = f_L + f_R + jump rises and is concave: Newton from below its root never overshoots (eq. 4.5).
    const auto mismatch = [&](double p) {
        return velocity_change(left, p) + velocity_change(right, p) + jump;
    };
    double p = std::min(left.pressure, right.pressure);
    while (mismatch(p) > 0) p *= 0.5;
    for (int i = 0; i < 200; ++i) {
        const double step = -mismatch(p) / (velocity_change_slope(left, p) + velocity_change_slope(right, p));
        p += step;
        if (std::abs(step) <= 1e-15 * p) break;
    }
    star_pressure_ = p;
    star_velocity_ =
        0.5 * (left.velocity + right.velocity + velocity_change(right, p) - velocity_change(left, p));
}

double ExactRiemann::sound_speed(const GasState& state) const {
    return std::sqrt(gamma_ * state.pressure / state.density);
}

/// Toro eqs 4.6 and 4.7: a shock if the pressure rises, a rarefaction if it falls.
double ExactRiemann::velocity_change(const GasState& side, double pressure) const {
    if (pressure > side.pressure) {
        const double a = 2 / ((gamma_ + 1) * side.density);
        const double b = (gamma_ - 1) / (gamma_ + 1) * side.pressure;
        return (pressure - side.pressure) * std::sqrt(a / (pressure + b));
    }
    const double power = (gamma_ - 1) / (2 * gamma_);
    return 2 * sound_speed(side) / (gamma_ - 1) * (std::pow(pressure / side.pressure, power) - 1);
}

double ExactRiemann::velocity_change_slope(const GasState& side, double pressure) const {  // eq. 4.37
    if (pressure > side.pressure) {
        const double a = 2 / ((gamma_ + 1) * side.density);
        const double b = (gamma_ - 1) / (gamma_ + 1) * side.pressure;
        return std::sqrt(a / (pressure + b)) * (1 - 0.5 * (pressure - side.pressure) / (pressure + b));
    }
    return std::pow(pressure / side.pressure, -(gamma_ + 1) / (2 * gamma_)) /
           (side.density * sound_speed(side));
}

double ExactRiemann::star_density(const GasState& side) const {
    const double ratio = star_pressure_ / side.pressure;
    if (ratio > 1) {  // eq. 4.50
        const double g = (gamma_ - 1) / (gamma_ + 1);
        return side.density * (ratio + g) / (g * ratio + 1);
    }
    return side.density * std::pow(ratio, 1 / gamma_);  // eq. 4.53
}

WaveSpeeds ExactRiemann::wave_speeds() const {
    WaveSpeeds waves{};
    waves.contact = star_velocity_;
    const auto outer = [&](const GasState& side, double star_velocity, double& head, double& tail) {
        const double ratio = star_pressure_ / side.pressure;
        const double c = sound_speed(side);
        if (ratio > 1) {  // eq. 4.52
            head = tail = side.velocity -
                          c * std::sqrt((gamma_ + 1) / (2 * gamma_) * ratio + (gamma_ - 1) / (2 * gamma_));
        } else {  // eq. 4.55
            head = side.velocity - c;
            tail = star_velocity - c * std::pow(ratio, (gamma_ - 1) / (2 * gamma_));
        }
    };
    outer(left_, star_velocity_, waves.left_head, waves.left_tail);
    outer(mirrored(right_), -star_velocity_, waves.right_head, waves.right_tail);
    waves.right_head = -waves.right_head;
    waves.right_tail = -waves.right_tail;
    return waves;
}

GasState ExactRiemann::sample(double speed) const {
    const WaveSpeeds waves = wave_speeds();
    const bool on_left = speed < waves.contact;
    const GasState& side = on_left ? left_ : right_;
    const double outward = on_left ? -1 : 1;
    const double head = on_left ? waves.left_head : waves.right_head;
    const double tail = on_left ? waves.left_tail : waves.right_tail;
    if (outward * speed >= outward * head) return side;
    if (outward * speed <= outward * tail) return {star_density(side), star_velocity_, star_pressure_};
    // Inside the fan, eqs 4.56 and 4.63.
    const double c = sound_speed(side);
    const double c_fan = 2 / (gamma_ + 1) * (c - outward * (gamma_ - 1) / 2 * (side.velocity - speed));
    const double ratio = c_fan / c;
    return {side.density * std::pow(ratio, 2 / (gamma_ - 1)), speed - outward * c_fan,
            side.pressure * std::pow(ratio, 2 * gamma_ / (gamma_ - 1))};
}

}  // namespace talus::reference
