#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/support/lattice_dispersion.hpp"

namespace talus::reference {
namespace {

constexpr double pi = std::numbers::pi;

/// The non-linear equations of motion on a lattice, periodic over `period` particles along x and endless
/// across it, evaluated with displacements that depend on x alone. Nothing is linearised and no published
/// coefficient is used: V(s) is the Hermite interpolant itself, its square averaged by quadrature.
class LatticeForce {
  public:
    LatticeForce(const LatticeWave& wave, Interpolation interpolation, bool standard, int period)
        : wave_(wave), interpolation_(interpolation), standard_(standard), period_(period) {}

    /// -a / displacement of the crest, by central differences in the amplitude [1/s2].
    double omega_squared(int mode) const {
        const double amplitude = 1e-5 * wave_.spacing;
        return -(crest_acceleration(mode, amplitude) - crest_acceleration(mode, -amplitude)) /
               (2 * amplitude);
    }

  private:
    struct Profile {  // by index along x
        std::vector<double> x, rho, V, V_x, V_xx;
    };

    double kernel(double r2, double width) const {
        if (r2 >= std::pow(wave_.cutoff * width, 2)) return 0;
        return wave_.gradient_scale * std::pow(width * std::sqrt(pi), -wave_.dimension) *
               std::exp(-r2 / (width * width));
    }

    /// Calls visit(j, x_ij, r2) for the neighbours j of the particle in column i, itself left out.
    template <class Visit>
    void for_each_neighbour(const std::vector<double>& x, int i, double width, Visit visit) const {
        const double dx = wave_.spacing;
        const int n = static_cast<int>(wave_.cutoff * width / dx) + 2;
        const int ny = wave_.dimension > 1 ? n : 0, nz = wave_.dimension > 2 ? n : 0;
        for (int a = -n; a <= n; ++a) {
            const int j = ((i + a) % period_ + period_) % period_;
            const double laps = (i + a - j) * dx;
            const double x_ij = x[static_cast<std::size_t>(i)] - x[static_cast<std::size_t>(j)] - laps;
            for (int b = -ny; b <= ny; ++b)
                for (int c = -nz; c <= nz; ++c)
                    if (a != 0 || b != 0 || c != 0)
                        visit(static_cast<std::size_t>(j), x_ij, x_ij * x_ij + (b * b + c * c) * dx * dx);
        }
    }

    Profile profile(const std::vector<double>& x) const {
        const double h = wave_.smoothing_length,
                     mass = wave_.density * std::pow(wave_.spacing, wave_.dimension);
        const std::size_t n = x.size();
        Profile p{x, std::vector<double>(n), std::vector<double>(n), std::vector<double>(n),
                  std::vector<double>(n)};
        for (std::size_t i = 0; i < n; ++i) {
            double rho = mass * kernel(0, h), rho_x = 0;
            for_each_neighbour(x, static_cast<int>(i), h, [&](std::size_t, double x_ij, double r2) {
                rho += mass * kernel(r2, h);
                rho_x += mass * kernel(r2, h) * -2 * x_ij / (h * h);
            });
            p.rho[i] = rho;
            p.V[i] = 1 / rho;
            p.V_x[i] = -rho_x / (rho * rho);
        }
        for (std::size_t i = 0; i < n; ++i)
            for_each_neighbour(x, static_cast<int>(i), h, [&](std::size_t j, double x_ij, double r2) {
                p.V_xx[i] += mass / p.rho[j] * p.V_x[j] * kernel(r2, h) * -2 * x_ij / (h * h);
            });
        return p;
    }

    /// V at s = t * distance / 2 between j (t = -1) and i (t = 1) from values and derivatives at the ends.
    double interpolate(double t, double length, const std::array<double, 3>& j,
                       const std::array<double, 3>& i) const {
        const double u = (t + 1) / 2;  // 0 at j, 1 at i
        const auto from_end = [&](double w, const std::array<double, 3>& end, double sign) {
            const double slope = sign * end[1] * length, bend = end[2] * length * length;
            if (interpolation_ == Interpolation::linear) return (1 - w) * end[0];
            if (interpolation_ == Interpolation::cubic)
                return (1 - w) * (1 - w) * ((1 + 2 * w) * end[0] + w * slope);
            return std::pow(1 - w, 3) *
                   ((1 + 3 * w + 6 * w * w) * end[0] + w * (1 + 3 * w) * slope + w * w / 2 * bend);
        };
        return from_end(u, j, 1) + from_end(1 - u, i, -1);
    }

    /// Mean of V(s)^2 with the weight exp(-2 s^2 / h^2); the trapezoidal rule is exact to rounding.
    double mean_V2(double length, const std::array<double, 3>& j, const std::array<double, 3>& i) const {
        double sum = 0, weights = 0;
        for (int q = -24; q <= 24; ++q) {
            const double s = 0.2 * q * wave_.smoothing_length;
            const double weight = std::exp(-2 * s * s / (wave_.smoothing_length * wave_.smoothing_length));
            sum += weight * std::pow(interpolate(2 * s / length, length, j, i), 2);
            weights += weight;
        }
        return sum / weights;
    }

    double crest_acceleration(int mode, double amplitude) const {
        const double k = 2 * pi * mode / (period_ * wave_.spacing);
        std::vector<double> x(static_cast<std::size_t>(period_));
        for (std::size_t i = 0; i < x.size(); ++i) {
            const double rest = static_cast<double>(i) * wave_.spacing;
            x[i] = rest + amplitude * std::cos(k * rest);
        }
        const Profile p = profile(x);
        const std::vector<double> at_rest_x = [&] {
            std::vector<double> rest(x.size());
            for (std::size_t i = 0; i < x.size(); ++i) rest[i] = static_cast<double>(i) * wave_.spacing;
            return rest;
        }();
        const double rho_at_rest = profile(at_rest_x).rho[0];
        const auto pressure = [&](std::size_t i) {
            return wave_.pressure + wave_.sound_speed * wave_.sound_speed * (p.rho[i] - rho_at_rest);
        };
        const double mass = wave_.density * std::pow(wave_.spacing, wave_.dimension);
        const double width = wave_.smoothing_length * (standard_ ? 1 : std::numbers::sqrt2);
        double acceleration = 0;
        for_each_neighbour(x, 0, width, [&](std::size_t j, double x_ij, double r2) {
            const double gradient = kernel(r2, width) * -2 * x_ij / (width * width);
            if (standard_) {
                acceleration -= mass * gradient *
                                (pressure(0) / (p.rho[0] * p.rho[0]) + pressure(j) / (p.rho[j] * p.rho[j]));
                return;
            }
            if (gradient == 0) return;
            const double r = std::sqrt(r2), e_x = x_ij / r;
            const double V2 = mean_V2(r, {p.V[j], e_x * p.V_x[j], e_x * e_x * p.V_xx[j]},
                                      {p.V[0], e_x * p.V_x[0], e_x * e_x * p.V_xx[0]});
            acceleration -= mass * (pressure(0) + pressure(j)) / 2 * 2 * V2 * gradient;
        });
        return acceleration;
    }

    LatticeWave wave_;
    Interpolation interpolation_;
    bool standard_;
    int period_;
};

/// A wave with the kernel scaled so that the lattice's summed density is the nominal one exactly.
LatticeWave normalised(LatticeWave wave) {
    const int n = static_cast<int>(wave.cutoff * wave.smoothing_length / wave.spacing) + 1;
    const int ny = wave.dimension > 1 ? n : 0, nz = wave.dimension > 2 ? n : 0;
    double sum = 0;
    for (int a = -n; a <= n; ++a)
        for (int b = -ny; b <= ny; ++b)
            for (int c = -nz; c <= nz; ++c) {
                const double r2 = (a * a + b * b + c * c) * wave.spacing * wave.spacing;
                if (r2 < std::pow(wave.cutoff * wave.smoothing_length, 2))
                    sum += std::exp(-r2 / std::pow(wave.smoothing_length, 2));
            }
    wave.gradient_scale =
        std::pow(wave.smoothing_length * std::sqrt(pi) / wave.spacing, wave.dimension) / sum;
    return wave;
}

/// Largest difference between relation and direct linearisation over the modes of a periodic lattice.
double worst_difference(LatticeWave wave, Interpolation relation, bool standard = false) {
    const Interpolation direct =
        relation == Interpolation::quintic_as_printed ? Interpolation::quintic : relation;
    const int period = 8;
    double worst = 0;
    wave = normalised(wave);
    for (const double p : {1., -0.3}) {
        wave.pressure = p * wave.density * wave.sound_speed * wave.sound_speed;
        const LatticeForce force(wave, direct, standard, period);
        for (int mode = 1; mode <= period / 2; ++mode) {
            const double k = 2 * pi * mode / (period * wave.spacing);
            const double expected =
                standard ? standard_omega_squared(wave, k) : godunov_omega_squared(wave, relation, k);
            worst = std::max(worst, std::abs(force.omega_squared(mode) - expected) /
                                        std::pow(wave.sound_speed / wave.spacing, 2));
        }
    }
    return worst;
}

LatticeWave lattice(int dimension, double h = 1) {
    LatticeWave wave;
    wave.dimension = dimension;
    wave.spacing = 0.5;
    wave.smoothing_length = h * wave.spacing;
    wave.density = 3;
    wave.sound_speed = 2;
    wave.cutoff = dimension == 3 ? 4.01 : 6;
    return wave;
}

TEST(LatticeDispersion, RelationsAgreeWithTheNonLinearEquations) {
    for (const int dimension : {1, 2, 3}) {
        SCOPED_TRACE(dimension);
        const LatticeWave wave = lattice(dimension);
        EXPECT_LT(worst_difference(wave, Interpolation::linear), 1e-6);
        EXPECT_LT(worst_difference(wave, Interpolation::cubic), 1e-6);
        EXPECT_LT(worst_difference(wave, Interpolation::quintic), 1e-6);
        EXPECT_LT(worst_difference(wave, Interpolation::linear, true), 1e-6);
    }
}

TEST(LatticeDispersion, RelationsHoldForOtherSmoothingLengthsAndCuts) {
    for (const double h : {0.8, 1.3}) {
        SCOPED_TRACE(h);
        LatticeWave wave = lattice(2, h);
        wave.cutoff = 2.03;
        for (const auto interpolation : {Interpolation::linear, Interpolation::cubic, Interpolation::quintic})
            EXPECT_LT(worst_difference(wave, interpolation), 1e-6);
        EXPECT_LT(worst_difference(wave, Interpolation::linear, true), 1e-6);
    }
}

TEST(LatticeDispersion, PrintedQuinticRelationIsNotThatOfTheEquations) {
    for (const int dimension : {1, 2, 3}) {
        const double worst = worst_difference(lattice(dimension), Interpolation::quintic_as_printed);
        RecordProperty("dimension_" + std::to_string(dimension), std::to_string(worst));
        EXPECT_GT(worst, 0.01);
    }
}

double at_nyquist(int dimension, Interpolation interpolation) {
    LatticeWave wave;
    wave.dimension = dimension;
    const double zero = godunov_omega_squared(wave, interpolation, pi);
    wave.pressure = 1;
    return godunov_omega_squared(wave, interpolation, pi) - zero;
}

// omega^2 = A(k) + (P / rho C^2) B(k); at the shortest wave A = 0 and the sign of B decides.
TEST(LatticeDispersion, SignsAtTheShortestWaveDecideTheInterpolation) {
    const double cubic[] = {0.165, -0.108, -0.267}, quintic[] = {-0.266, -0.387, -0.483};
    for (const int dimension : {1, 2, 3}) {
        SCOPED_TRACE(dimension);
        const auto d = static_cast<std::size_t>(dimension - 1);
        EXPECT_NEAR(at_nyquist(dimension, Interpolation::linear), 0.284, 6e-4);
        EXPECT_NEAR(at_nyquist(dimension, Interpolation::cubic), cubic[d], 6e-4);
        EXPECT_NEAR(at_nyquist(dimension, Interpolation::quintic), quintic[d], 6e-4);
        LatticeWave wave;
        wave.dimension = dimension;
        EXPECT_NEAR(standard_omega_squared(wave, pi), 0, 1e-12);
        EXPECT_NEAR(godunov_omega_squared(wave, Interpolation::linear, pi), 0, 1e-12);
        wave.pressure = 1;
        EXPECT_NEAR(standard_omega_squared(wave, pi), 3.34, 5e-3);
    }
}

struct Band {
    int dimension;
    double pressure;  // [rho C^2]
    int scheme;       // 0 linear, 1 cubic, 2 quintic, 3 standard
    double from;      // [pi / spacing]
    double lowest;    // [(C / spacing)^2]
    double at;        // [pi / spacing]
};

double omega_squared(const Band& band, double k) {
    LatticeWave wave;
    wave.dimension = band.dimension;
    wave.pressure = band.pressure;
    if (band.scheme == 3) return standard_omega_squared(wave, k);
    return godunov_omega_squared(wave, static_cast<Interpolation>(band.scheme), k);
}

TEST(LatticeDispersion, UnstableBandsBeginAndPeakWhereExpected) {
    const Band bands[] = {
        {1, -1, 0, .400, -.532, .67}, {1, -.3, 0, .615, -.100, .80}, {1, -.1, 1, .855, -.0165, 1},
        {1, -1, 1, .595, -.194, .80}, {1, 1, 2, .695, -.266, 1},     {1, -.1, 3, .735, -.334, 1},
        {1, -1, 3, .380, -3.34, 1},   {2, 1, 1, .818, -.108, 1},     {2, .3, 2, .738, -.116, 1},
        {3, 1, 1, .705, -.267, 1},    {3, 1, 2, .565, -.483, 1},     {3, -1, 0, .400, -.532, .67},
    };
    for (const Band& band : bands) {
        SCOPED_TRACE(testing::Message()
                     << band.dimension << "D, scheme " << band.scheme << ", p " << band.pressure);
        EXPECT_GT(omega_squared(band, (band.from - 0.006) * pi), 0);
        EXPECT_LT(omega_squared(band, (band.from + 0.006) * pi), 0);
        const double lowest = omega_squared(band, band.at * pi);
        EXPECT_NEAR(lowest, band.lowest, 0.006 * std::abs(band.lowest) + 3e-4);
        for (double k = 0.05; k <= 1; k += 0.05)
            EXPECT_GT(omega_squared(band, k * pi), band.lowest * 1.01 - 3e-4);
    }
}

TEST(LatticeDispersion, AutomaticChoiceIsStableForBothSigns) {
    for (const int dimension : {1, 2, 3})
        for (double k = 0.02; k <= 1; k += 0.02) {
            const int in_tension = dimension == 1 ? 2 : 1;
            for (const double p : {0.1, 0.3, 1., 3.}) {
                EXPECT_GE(omega_squared({dimension, p, 0, 0, 0, 0}, k * pi), 0);
                EXPECT_GE(omega_squared({dimension, -p, in_tension, 0, 0, 0}, k * pi), 0);
            }
        }
}

TEST(LatticeDispersion, LongWavesTravelAtTheSoundSpeed) {
    for (const int dimension : {1, 2, 3}) {
        LatticeWave wave = normalised(lattice(dimension));
        const double k = 0.01 / wave.spacing, c_k = wave.sound_speed * k;
        for (const auto interpolation : {Interpolation::linear, Interpolation::cubic, Interpolation::quintic})
            EXPECT_NEAR(godunov_omega_squared(wave, interpolation, k) / (c_k * c_k), 1, 5e-3);
        EXPECT_NEAR(standard_omega_squared(wave, k) / (c_k * c_k), 1, 5e-3);
    }
}

}  // namespace
}  // namespace talus::reference
