#include "physics/water/sound_waves.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "physics/sph/kernels.hpp"

namespace talus::water {

namespace {

using Number = std::complex<double>;

/// Greater of the two factors of a step.
double factor(Number q) {
    const Number half = (1.0 + 1.5 * q) / 2.0, root = std::sqrt(half * half - q / 2.0);
    return std::max(std::abs(half + root), std::abs(half - root));
}

}  // namespace

WaveRates wave_rates(const Settings& settings, int dimension, const std::array<double, 3>& wave) {
    const double radius = settings.radius_in_spacings, spacing = settings.radius() / radius;
    const int reach = static_cast<int>(radius), reach_z = dimension == 3 ? reach : 0;
    const double norm = dimension == 3 ? sph::WendlandC2<3>::norm : sph::WendlandC2<2>::norm;
    std::array<double, 3> gradient{};
    double friction = 0;  // sum of V |grad W|/r (1 - cos(k.r))
    for (int a = -reach; a <= reach; ++a)
        for (int b = -reach; b <= reach; ++b)
            for (int c = -reach_z; c <= reach_z; ++c) {
                const double x = 1 - std::sqrt(a * a + b * b + c * c) / radius;
                if (x <= 0) continue;
                // of the volume of a particle times -W'(r)/r: R^2 times it, and the kernel in units of 2 h
                const double pull = 5 * norm * std::pow(Settings::support() / radius, dimension) *
                                    Settings::support() * Settings::support() * x * x * x;
                const double phase = spacing * (wave[0] * a + wave[1] * b + wave[2] * c);
                friction += pull * (1 - std::cos(phase));
                gradient[0] += pull * a * std::sin(phase);
                gradient[1] += pull * b * std::sin(phase);
                gradient[2] += pull * c * std::sin(phase);
            }
    const double c0 = settings.state.sound_speed, r2 = settings.radius() * settings.radius();
    friction /= r2;
    return {c0 * spacing / r2 * std::hypot(gradient[0], gradient[1], gradient[2]),
            2 * settings.density_diffusion * settings.smoothing_length * c0 * friction,
            2 * settings.viscosity / settings.state.reference_density * friction};
}

double growth(const WaveRates& rates, double time_step) {
    const double mean = (rates.diffusion + rates.viscosity) / 2,
                 difference = (rates.diffusion - rates.viscosity) / 2;
    const Number root = std::sqrt(Number(difference * difference - rates.sound * rates.sound));
    return std::max({factor((-mean + root) * time_step), factor((-mean - root) * time_step),
                     factor(-rates.viscosity * time_step)});
}

GrowingWave fastest_growing(const Settings& settings, int dimension, double time_step) {
    constexpr int length = 12;
    const double spacing = settings.radius() / settings.radius_in_spacings,
                 first = 2 * std::numbers::pi / (length * spacing);
    GrowingWave fastest;
    for (int p = 0; p <= length / 2; ++p)
        for (int q = 0; q <= p; ++q)
            for (int r = 0; r <= (dimension == 3 ? q : 0); ++r) {
                if (p == 0) continue;
                const std::array<double, 3> wave{p * first, q * first, r * first};
                const double found = growth(wave_rates(settings, dimension, wave), time_step);
                if (found > fastest.growth) fastest = {wave, found};
            }
    return fastest;
}

double greatest_courant(Settings settings, int dimension, double most) {
    constexpr double negligible = 1e-6, accuracy = 1e-4;
    const auto bears = [&](double courant) {
        const double step = courant * settings.smoothing_length / settings.state.sound_speed;
        return fastest_growing(settings, dimension, step).growth < 1 + negligible;
    };
    if (bears(most)) return most;
    double least = 0;
    while (most - least > accuracy) {
        const double middle = (least + most) / 2;
        (bears(middle) ? least : most) = middle;
    }
    return least;
}

}  // namespace talus::water
