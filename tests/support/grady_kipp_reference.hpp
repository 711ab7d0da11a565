#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include "physics/solid/fracture.hpp"

/// Strength of rock pulled at a constant strain rate: the strain is eps = rate * t everywhere, the stress
/// E eps (1 - D), and the failure stress its maximum over time.
namespace talus::test {

/// Rock and the volume element that its flaws are counted in.
struct PulledRock {
    double young_modulus;      ///< E [Pa]
    double crack_speed;        ///< c_g [m/s]
    double weibull_k;          ///< [1/m3]
    double weibull_m;          ///< [1]
    double volume = 0;         ///< of a particle, whose mean number of open flaws is k V eps^m [m3]
    double radius = 0;         ///< R_s that a crack has to cross [m]
    double power = 1.0 / 3.0;  ///< p of dD^(1/3)/dt = n^p c_g / R_s
};

/// Failure stress [Pa] of a continuum of cracks, each a sphere growing since its own flaw opened:
/// D = alpha rate^m t^(m+3), alpha = 8 pi c_g^3 k / ((m+1)(m+2)(m+3)), most stress at D = 1/(m+4).
/// Proportional to rate^(3/(m+3)). D. E. Grady, M. E. Kipp, Int. J. Rock Mech. Min. Sci. 17 (1980) 147;
/// H. J. Melosh, E. V. Ryan, E. Asphaug, J. Geophys. Res. 97 (1992) 14735.
inline double classic_failure_stress(const PulledRock& rock, double rate) {
    const double m = rock.weibull_m;
    const double log_alpha = std::log(8 * std::numbers::pi / ((m + 1) * (m + 2) * (m + 3))) +
                             3 * std::log(rock.crack_speed) + std::log(rock.weibull_k);
    const double log_time = -(log_alpha + m * std::log(rate) + std::log(m + 4)) / (m + 3);
    return rock.young_modulus * rate * std::exp(log_time) * (m + 3) / (m + 4);
}

/// Failure stress [Pa] where D^(1/3) grows at n^p c_g / R_s with n = k V eps^m flaws open, not rounded to
/// whole flaws and with D not bounded by the open fraction: D^(1/3) = c_g/R_s (k V rate^m)^p t^(q) / q, q = m
/// p + 1, most stress at D = 1/(3 q + 1). For p = 1/3 proportional to rate^(3/(m+3)), and without a trace of
/// the element's size if V = 4 pi R_s^3 / 3.
inline double many_flaw_failure_stress(const PulledRock& rock, double rate) {
    const double q = rock.weibull_m * rock.power + 1, worst_damage = 1 / (3 * q + 1);
    const double log_flaws =
        std::log(rock.weibull_k) + std::log(rock.volume) + rock.weibull_m * std::log(rate);
    const double log_speed = std::log(rock.crack_speed / rock.radius) + rock.power * log_flaws - std::log(q);
    const double time = std::exp((std::log(worst_damage) / 3 - log_speed) / q);
    return rock.young_modulus * rate * time * (1 - worst_damage);
}

/// Failure stress [Pa] of a particle with one flaw: D = x^3, x = (eps - threshold)/eps_R, eps_R = rate
/// R_s/c_g, most stress where 1 - x^3 - 3 x^2 (threshold/eps_R + x) = 0. The stress never falls below E
/// threshold.
inline double one_flaw_failure_stress(const PulledRock& rock, double threshold, double rate) {
    const double crossing = rate * rock.radius / rock.crack_speed, start = threshold / crossing;
    double low = 0, high = 1;
    for (int i = 0; i < 100; ++i) {
        const double x = 0.5 * (low + high);
        (1 - 4 * x * x * x - 3 * x * x * start > 0 ? low : high) = x;
    }
    return rock.young_modulus * crossing * (start + low) * (1 - low * low * low);
}

/// Every flaw of a particle by its threshold, in order.
struct ListedFlaws {
    std::vector<double> thresholds;
    double count = 0;

    double open(double strain) const {
        return static_cast<double>(std::upper_bound(thresholds.begin(), thresholds.end(), strain) -
                                   thresholds.begin());
    }
};

/// Flaws as W. Benz, E. Asphaug, Icarus 107 (1994) 98, section 2.3, deal them out: the j-th of a body has the
/// threshold (j/(k V))^(1/m), V the body's volume, and goes to a particle drawn at random, until each has
/// one.
inline std::vector<ListedFlaws> deal_flaws(const PulledRock& rock, std::size_t particles, unsigned seed) {
    std::mt19937_64 random(seed);
    std::uniform_int_distribution<std::size_t> any(0, particles - 1);
    const double body_volume = rock.volume * static_cast<double>(particles);
    std::vector<ListedFlaws> dealt(particles);
    std::size_t without = particles;
    for (double j = 1; without > 0; ++j) {
        ListedFlaws& to = dealt[any(random)];
        without -= to.thresholds.empty() ? 1 : 0;
        to.thresholds.push_back(std::pow(j / (rock.weibull_k * body_volume), 1 / rock.weibull_m));
        to.count += 1;
    }
    return dealt;
}

/// One point of a stress-strain curve.
struct PullPoint {
    double strain, stress, damage;  ///< stress [Pa] and damage are means over the particles
};

/// Stress and damage of given particles pulled together, up to `last_strain` in `steps` steps, by the
/// midpoint rule and with D bounded by (open/count)^(1/3) if `bounded`.
template <class Particle>
std::vector<PullPoint> pull(const PulledRock& rock, std::span<const Particle> particles, double rate,
                            double last_strain, int steps, bool bounded = true) {
    std::vector<double> damage(particles.size(), 0.0);
    std::vector<PullPoint> curve;
    const double step = last_strain / steps;
    for (int s = 0; s < steps; ++s) {
        PullPoint mean{(s + 1) * step, 0, 0};
        for (std::size_t i = 0; i < particles.size(); ++i) {
            const double open = particles[i].open((s + 0.5) * step);
            if (open > 0 && damage[i] < 1) {
                const double root = std::cbrt(damage[i]) +
                                    std::pow(open, rock.power) * rock.crack_speed / rock.radius * step / rate;
                const double bound = bounded ? std::cbrt(open / particles[i].count) : 1.0;
                damage[i] = std::max(damage[i], std::min(root * root * root, bound));
            }
            mean.damage += damage[i] / static_cast<double>(particles.size());
        }
        mean.stress = rock.young_modulus * mean.strain * (1 - mean.damage);
        curve.push_back(mean);
    }
    return curve;
}

/// Largest stress [Pa] of a curve.
inline double failure_stress(std::span<const PullPoint> curve) {
    double most = 0;
    for (const PullPoint& point : curve) most = std::max(most, point.stress);
    return most;
}

}  // namespace talus::test
