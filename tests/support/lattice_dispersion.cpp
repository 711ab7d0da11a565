#include "tests/support/lattice_dispersion.hpp"

#include <cmath>
#include <numbers>

namespace talus::reference {

namespace {

struct Neighbour {
    double x;              // x_i - x_j [m]
    double r2;             // squared distance [m2]
    double first, second;  // dW/dx and d2W/dx2 times the particle volume
    double sine, lag;      // sin(k x) and 1 - cos(k x)
};

/// Calls `visit` for each lattice neighbour within the cut of W(r, width).
template <class Visit>
void for_each_neighbour(const LatticeWave& wave, double wavenumber, double width, Visit visit) {
    const double reach = wave.cutoff * width;
    const int shells = static_cast<int>(reach / wave.spacing) + 1;
    const int shells_y = wave.dimension > 1 ? shells : 0, shells_z = wave.dimension > 2 ? shells : 0;
    const double scale =
        wave.gradient_scale * std::pow(wave.spacing / (width * std::sqrt(std::numbers::pi)), wave.dimension);
    const double w2 = width * width;
    for (int a = -shells; a <= shells; ++a)
        for (int b = -shells_y; b <= shells_y; ++b)
            for (int c = -shells_z; c <= shells_z; ++c) {
                const double x = a * wave.spacing;
                const double r2 = (a * a + b * b + c * c) * wave.spacing * wave.spacing;
                if (a == 0 || r2 >= reach * reach * (1 - 1e-12)) continue;  // no term of any sum has x = 0
                const double kernel = scale * std::exp(-r2 / w2);
                visit(Neighbour{x, r2, -2 * x / w2 * kernel, (4 * x * x / w2 - 2) / w2 * kernel,
                                std::sin(wavenumber * x), 1 - std::cos(wavenumber * x)});
            }
}

/// The two sums with W(r, h): D (eq. 2.129) [1/m] and C_rho (eq. 2.132) [1/m2].
struct DensitySums {
    double slope = 0, curvature = 0;
};

DensitySums density_sums(const LatticeWave& wave, double wavenumber) {
    DensitySums sums;
    for_each_neighbour(wave, wavenumber, wave.smoothing_length, [&](const Neighbour& n) {
        sums.slope -= n.sine * n.first;
        sums.curvature += n.lag * n.second;
    });
    return sums;
}

}  // namespace

double godunov_omega_squared(const LatticeWave& wave, Interpolation interpolation, double wavenumber) {
    const double h2 = wave.smoothing_length * wave.smoothing_length, h4 = h2 * h2;
    const auto [D, C_rho] = density_sums(wave, wavenumber);
    double a = 0, b = 0;                  // eq. 2.135; a = A_{0,0}
    double B_10 = 0, B_12 = 0, B_14 = 0;  // eqs 2.137 and 2.139: c = B_{1,2}, d = B_{1,0}
    double A_20 = 0, A_22 = 0, A_24 = 0;  // eq. 2.139
    for_each_neighbour(wave, wavenumber, std::numbers::sqrt2 * wave.smoothing_length,
                       [&](const Neighbour& n) {
                           const double A = n.sine * n.first, B = n.lag * n.first;
                           a += A;
                           b += n.lag * n.second;
                           B_10 += n.x * B;
                           B_12 += n.x / n.r2 * B;
                           B_14 += n.x / (n.r2 * n.r2) * B;
                           A_20 += n.x * n.x * A;
                           A_22 += n.x * n.x / n.r2 * A;
                           A_24 += n.x * n.x / (n.r2 * n.r2) * A;
                       });
    double bracket = 2 * D * a + 2 * b;
    switch (interpolation) {
        case Interpolation::linear:
            break;
        case Interpolation::cubic:
            bracket += C_rho * (-h2 / 2 * B_12 + B_10 / 2);
            break;
        case Interpolation::quintic:
        case Interpolation::quintic_as_printed: {
            const double sign = interpolation == Interpolation::quintic ? -1 : 1;
            bracket += C_rho * (3. / 8 * h4 * B_14 - 3. / 4 * h2 * B_12 + 5. / 8 * B_10);
            bracket += sign * C_rho * D * (3. / 16 * h4 * A_24 - h2 / 8 * A_22 + A_20 / 16);
            break;
        }
    }
    return -wave.sound_speed * wave.sound_speed * D * a + wave.pressure / wave.density * bracket;
}

double standard_omega_squared(const LatticeWave& wave, double wavenumber) {
    const auto [D, C_rho] = density_sums(wave, wavenumber);
    const double specific = wave.pressure / wave.density;
    return (wave.sound_speed * wave.sound_speed - 2 * specific) * D * D + 2 * specific * C_rho;
}

}  // namespace talus::reference
