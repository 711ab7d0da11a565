#include "physics/solid/fracture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talus {

double Flaws::open(double strain) const {
    if (count == 0 || strain < static_cast<double>(threshold)) return 0;
    const double all = count;
    return std::clamp(std::pow(strain / static_cast<double>(threshold), static_cast<double>(exponent)), 1.0,
                      all);
}

FlawSampler::FlawSampler(const Fracture& fracture, double volume, std::uint64_t particles, std::uint64_t seed,
                         std::uint8_t body)
    : stream_{seed, RandomPurpose::flaws, body},
      inverse_m_(1 / fracture.weibull_m),
      weibull_m_(fracture.weibull_m),
      log_particle_flaws_(std::log(fracture.weibull_k) + std::log(volume / static_cast<double>(particles))) {
    // P(X < x) = (1 - e^-x)^N inverted. No particle has the largest id, so its numbers are the body's.
    const double u = stream_.uniform(std::numeric_limits<std::uint64_t>::max(), 0);
    last_ = -std::log(-std::expm1(std::log(u) / static_cast<double>(particles)));
}

double FlawSampler::mean_count() const { return last_ / -std::expm1(-last_); }

Flaws FlawSampler::sample(std::uint64_t id) const {
    const double first = -std::log1p(stream_.uniform(id, 0) * std::expm1(-last_));
    double strongest = first;
    std::uint32_t count = 1;
    for (;;) {
        const double next = strongest - std::log(stream_.uniform(id, count));
        if (next > last_) break;
        strongest = next;
        ++count;
    }
    Flaws flaws;
    flaws.threshold = static_cast<float>(std::exp((std::log(first) - log_particle_flaws_) * inverse_m_));
    flaws.count = count;
    // Two flaws of all but equal strength would have an infinite exponent.
    constexpr double steepest = 1e30;
    if (count > 1)
        flaws.exponent = static_cast<float>(std::min(
            weibull_m_ * std::log(static_cast<double>(count)) / std::log(strongest / first), steepest));
    return flaws;
}

DamageRate damage_rate(const CrackGrowth& growth, const Flaws& flaws, double strain, double radius) {
    const double open = flaws.open(strain);
    if (open == 0) return {};
    const double power =
        growth.crack_count_power == 1.0 / 3.0 ? std::cbrt(open) : std::pow(open, growth.crack_count_power);
    return {power * growth.crack_speed / radius, std::cbrt(open / static_cast<double>(flaws.count))};
}

namespace {

template <int dimension>
DamageRate rate_of(const CrackGrowth& growth, const FractureState& state, std::size_t i) {
    const double strain = tensile_strain<dimension>(state.pressure[i], deviator<dimension>(state.stress, i),
                                                    growth.young_modulus);
    return damage_rate(growth, state.flaws[i], strain, state.radius_factor * state.radius[i]);
}

template <int dimension>
void grow(const CrackGrowth& growth, const FractureState& state, double dt, std::span<double> damage,
          std::span<const std::uint8_t> body, std::uint8_t which) {
    for (std::size_t i = 0; i < body.size(); ++i) {
        if (body[i] != which || damage[i] >= 1) continue;
        const DamageRate r = rate_of<dimension>(growth, state, i);
        if (damage[i] >= r.limit) continue;
        const double root = std::cbrt(damage[i]) + r.rate * dt;
        damage[i] = std::min(root * root * root, r.limit);
    }
}

template <int dimension>
double time_step(const CrackGrowth& growth, const FractureState& state, double most,
                 std::span<const double> damage, std::span<const std::uint8_t> body, std::uint8_t which) {
    double step = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < body.size(); ++i) {
        if (body[i] != which || damage[i] >= 1) continue;
        const DamageRate r = rate_of<dimension>(growth, state, i);
        if (std::cbrt(damage[i]) + most >= std::cbrt(r.limit)) continue;
        step = std::min(step, most / r.rate);
    }
    return step;
}

}  // namespace

void grow_damage(const CrackGrowth& growth, const FractureState& state, double dt, std::span<double> damage,
                 std::span<const std::uint8_t> body, std::uint8_t which) {
    if (state.stress.dimension == 1) grow<1>(growth, state, dt, damage, body, which);
    if (state.stress.dimension == 2) grow<2>(growth, state, dt, damage, body, which);
    if (state.stress.dimension == 3) grow<3>(growth, state, dt, damage, body, which);
}

double damage_time_step(const CrackGrowth& growth, const FractureState& state, double most,
                        std::span<const double> damage, std::span<const std::uint8_t> body,
                        std::uint8_t which) {
    if (state.stress.dimension == 1) return time_step<1>(growth, state, most, damage, body, which);
    if (state.stress.dimension == 2) return time_step<2>(growth, state, most, damage, body, which);
    return time_step<3>(growth, state, most, damage, body, which);
}

}  // namespace talus
