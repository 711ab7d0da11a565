#include "physics/soil/constitutive.hpp"

#include <algorithm>
#include <cmath>

namespace talus::soil {

double trace(const Tensor& t) { return t[0] + t[1] + t[2]; }

Tensor deviator(const Tensor& t) {
    const double mean = trace(t) / 3;
    return {t[0] - mean, t[1] - mean, t[2] - mean, t[3], t[4], t[5]};
}

double contraction(const Tensor& a, const Tensor& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2 * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
}

double mises_stress(const Tensor& stress) {
    const Tensor s = deviator(stress);
    return std::sqrt(1.5 * contraction(s, s));
}

Tensor Elasticity::stress_of(const Tensor& strain) const {
    if (uniaxial_stress) return {youngs_modulus * strain[0], 0, 0, 0, 0, 0};
    const double shear = shear_modulus(), spherical = (bulk_modulus() - 2.0 / 3 * shear) * trace(strain);
    Tensor stress;
    for (std::size_t k = 0; k < 6; ++k) stress[k] = 2 * shear * strain[k] + (k < 3 ? spherical : 0);
    return stress;
}

double Elasticity::energy(const Tensor& stress) const {
    if (uniaxial_stress) return stress[0] * stress[0] / (2 * youngs_modulus);
    const Tensor s = deviator(stress);
    const double mean = trace(stress) / 3;
    return contraction(s, s) / (4 * shear_modulus()) + mean * mean / (2 * bulk_modulus());
}

Yielding VonMises::at(const Tensor& stress, const History& history, double strength_factor) const {
    const double q = mises_stress(stress);
    const double limit = strength_factor * std::max(residual, yield_stress + hardening * history.strain);
    Yielding found{q - limit, {}};
    if (found.excess <= 0) return found;
    found.flow = deviator(stress);
    for (double& component : found.flow) component *= 1.5 / q;
    return found;
}

double VonMises::fastest_rate(const Elasticity& elasticity) const {
    return 3 * elasticity.shear_modulus() + std::max(hardening, 0.0);
}

Yielding DruckerPrager::at(const Tensor& stress, const History& history, double strength_factor) const {
    const double limit = strength_factor * std::max(residual, cohesion + hardening * history.strain);
    const double slope = strength_factor * friction;
    const Cone cone = cone_of_slopes(match, limit, slope, std::min(dilation, slope));
    const Tensor s = deviator(stress);
    const double root = std::sqrt(0.5 * contraction(s, s));
    const double alpha = cone.friction / 3, along = cone.dilation / 3;
    Yielding found{root + alpha * trace(stress) - cone.cohesion, {}};
    if (found.excess <= 0) return found;
    // Beyond the apex shear cannot lead back. There the flow turns from the potential's, on the apex's mean
    // stress, to a change of volume alone, where no shear is left.
    const double beyond = std::max(0.0, found.excess - root);
    const double volume = along + (alpha - along) * beyond / found.excess;
    for (std::size_t k = 0; k < 6; ++k) found.flow[k] = s[k] / (2 * (root + beyond)) + (k < 3 ? volume : 0);
    return found;
}

double DruckerPrager::fastest_rate(const Elasticity& elasticity) const {
    const double slope = cone_of_slopes(match, cohesion, friction, dilation).friction;
    return elasticity.shear_modulus() + elasticity.bulk_modulus() * slope * slope + std::max(hardening, 0.0);
}

Yielding CamClay::at(const Tensor& stress, const History& history, double) const {
    const double size = history.preconsolidation, p = -trace(stress) / 3, q = mises_stress(stress);
    Yielding found{(q * q / (slope * slope) + p * (p - size)) / size, {}};
    if (found.excess <= 0) return found;
    const Tensor s = deviator(stress);
    for (std::size_t k = 0; k < 6; ++k)
        found.flow[k] = (3 * s[k] / (slope * slope) - (k < 3 ? (2 * p - size) / 3 : 0)) / size;
    return found;
}

double CamClay::fastest_rate(const Elasticity& elasticity) const {
    return elasticity.bulk_modulus() + 12 * elasticity.shear_modulus() / (slope * slope) +
           hardening_rate() * preconsolidation;
}

double Material::wave_speed() const { return std::sqrt(elasticity.wave_modulus() / density); }

namespace {

/// Stress and history, as one vector for the Runge-Kutta steps.
struct Point {
    Tensor stress;
    History history;

    Point plus(double factor, const Point& rate) const {
        Point sum = *this;
        for (std::size_t k = 0; k < 6; ++k) sum.stress[k] += factor * rate.stress[k];
        sum.history.strain += factor * rate.history.strain;
        sum.history.work += factor * rate.history.work;
        sum.history.preconsolidation += factor * rate.history.preconsolidation;
        return sum;
    }
};

template <class Surface>
Point rate_of(const Surface& surface, const Material& material, double strength_factor, const Point& at) {
    Point rate{};
    const Yielding yielding = surface.at(at.stress, at.history, strength_factor);
    if (yielding.excess <= 0) return rate;
    const Overstress& law = material.overstress;
    const double over = yielding.excess / law.reference;
    const double speed = law.fluidity * (law.exponent == 1 ? over : std::pow(over, law.exponent));
    Tensor strain;
    for (std::size_t k = 0; k < 6; ++k) strain[k] = speed * yielding.flow[k];
    rate.stress = material.elasticity.stress_of(strain);
    for (double& component : rate.stress) component = -component;
    const Tensor shear = deviator(strain);
    rate.history.strain = std::sqrt(2.0 / 3 * contraction(shear, shear));
    rate.history.work = contraction(at.stress, strain);
    if constexpr (requires { surface.hardening_rate(); })
        rate.history.preconsolidation =
            -trace(strain) * surface.hardening_rate() * at.history.preconsolidation;
    return rate;
}

template <class Surface>
double rate_at(const Surface& surface, const Material& material, double excess) {
    const Overstress& law = material.overstress;
    return law.fluidity * law.exponent * surface.fastest_rate(material.elasticity) / law.reference *
           (law.exponent == 1 ? 1 : std::pow(excess / law.reference, law.exponent - 1));
}

template <class Surface>
bool relax_on(const Surface& surface, const Material& material, double strength_factor, double time_step,
              Tensor& stress, History& history) {
    constexpr int most_substeps = 10000;
    const auto rate = [&](const Point& at) { return rate_of(surface, material, strength_factor, at); };
    Point now{stress, history};
    double left = time_step, enough = 0;
    for (int k = 0; left > 0; ++k) {
        const double excess = surface.at(now.stress, now.history, strength_factor).excess;
        if (!(excess > enough)) break;
        if (k == 0) enough = 1e-9 * excess + 1e-12 * std::sqrt(contraction(stress, stress));  // of rounding
        // Each a fraction of the fastest rate's time: Runge-Kutta of fourth order is stable up to 2.78.
        const double steps = std::max(1.0, std::ceil(left * rate_at(surface, material, excess)));
        if (k == most_substeps || !std::isfinite(steps)) return false;
        const double dt = left / steps;
        const Point k1 = rate(now), k2 = rate(now.plus(dt / 2, k1)), k3 = rate(now.plus(dt / 2, k2)),
                    k4 = rate(now.plus(dt, k3));
        now = now.plus(dt / 6, k1.plus(2, k2).plus(2, k3).plus(1, k4));
        left = steps > 1 ? left - dt : 0;
    }
    stress = now.stress;
    history = now.history;
    return true;
}

}  // namespace

bool relax(const Material& material, double strength_factor, double time_step, Tensor& stress,
           History& history) {
    return std::visit(
        [&]<class Surface>(const Surface& surface) {
            if constexpr (std::is_same_v<Surface, Elastic>)
                return true;
            else
                return relax_on(surface, material, strength_factor, time_step, stress, history);
        },
        material.surface);
}

}  // namespace talus::soil
