#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "domain/soil_fields.hpp"
#include "tests/support/soil_run.hpp"

/// Saturated soil against closed solutions. The tables printed are those of the scenes' READMEs.
namespace talus::test {
namespace {

using std::numbers::pi;
const std::filesystem::path runs = std::filesystem::path(TALUS_SOURCE_DIR) / "runs";

bool is_root() { return Communicator(MPI_COMM_WORLD).is_root(); }

/// Complex amplitude of the pore pressure over that of the load at depths of a column of 30 m, drained at the
/// top: u = sum_j A_j exp(lambda_j x), p = sum_j A_j B_j exp(lambda_j x), B = (D lambda^2 + rho w^2)/lambda,
/// for the skeleton and water moving together (no inertia of the water against the skeleton).
std::vector<std::complex<double>> zienkiewicz(double permeability, const std::vector<double>& depths) {
    using Complex = std::complex<double>;
    constexpr double length = 30, density = 1666.7, stiffness = 8.333e8, mixture = 3e10,
                     omega = 2 * pi * 0.5381;
    const Complex i(0, 1), a = -permeability * stiffness,
                           b = i * omega * (stiffness / mixture + 1) - permeability * density * omega * omega,
                           c = i * density * omega * omega * omega / mixture;
    const Complex root = std::sqrt(b * b - 4.0 * a * c);
    const Complex first = std::sqrt((-b + root) / (2.0 * a)), second = std::sqrt((-b - root) / (2.0 * a));
    const std::array<Complex, 4> lambda{first, -first, second, -second};
    std::array<Complex, 4> ratio;
    Eigen::Matrix4cd conditions;
    // Each exponential is 1 at the end where it is largest.
    const auto wave = [&](std::size_t j, double x) {
        return std::exp(lambda[j] * (x - (lambda[j].real() > 0 ? length : 0)));
    };
    for (std::size_t j = 0; j < 4; ++j) {
        ratio[j] = (stiffness * lambda[j] * lambda[j] + density * omega * omega) / lambda[j];
        const auto k = static_cast<Eigen::Index>(j);
        conditions(0, k) = lambda[j] * wave(j, 0);
        conditions(1, k) = ratio[j] * wave(j, 0);
        conditions(2, k) = wave(j, length);
        conditions(3, k) = ratio[j] * lambda[j] * wave(j, length);
    }
    const Eigen::Vector4cd amplitudes =
        conditions.fullPivLu().solve(Eigen::Vector4cd(-1 / stiffness, 0, 0, 0));
    std::vector<Complex> pressure;
    for (const double x : depths) {
        Complex sum = 0;
        for (std::size_t j = 0; j < 4; ++j)
            sum += amplitudes[static_cast<Eigen::Index>(j)] * ratio[j] * wave(j, x);
        pressure.push_back(sum);
    }
    return pressure;
}

struct ColumnErrors {
    double amplitude, both;  ///< relative L2 over depth: of |p|, of amplitude and phase together
};

ColumnErrors column_errors(double permeability, int elements) {
    constexpr double frequency = 0.5381, period = 1 / frequency;
    const Communicator alone(MPI_COMM_SELF);
    const SoilScene scene = soil_scene(alone, runs / "saturated_column",
                                       {fmt::format("materials.soil.permeability={}", permeability),
                                        fmt::format("soil.spacing={}", 30.0 / elements), "run.end_time=5.6",
                                        "soil.damping=0", "boundary[1].change.times=[0, 1.86]"});
    std::vector<double> depths;
    std::vector<std::complex<double>> sums;
    double count = 0;
    const double begin = 5.6 - 2 * period;
    run_soil(alone, scene, [&](const SoilSimulation& simulation) {
        const auto nodes = soil_nodes(simulation.particles());
        if (depths.empty())
            for (const std::size_t i : nodes)
                depths.push_back(30 - simulation.particles().data(field::position)[i]);
        sums.resize(depths.size());
        // Whole periods: what swings otherwise averages out.
        if (simulation.time() < begin || simulation.time() >= begin + 2 * period) return;
        const std::complex<double> turn = std::polar(1.0, -2 * pi * frequency * simulation.time());
        for (std::size_t k = 0; k < nodes.size(); ++k)
            sums[k] += turn * simulation.particles().data(soil_field::pore_pressure)[nodes[k]];
        ++count;
    });
    const auto exact = zienkiewicz(permeability, depths);
    double of_amplitude = 0, of_both = 0, size = 0;
    for (std::size_t k = 0; k < depths.size(); ++k) {
        const std::complex<double> found = 2.0 * sums[k] / count / 1000.0;
        of_amplitude += std::pow(std::abs(found) - std::abs(exact[k]), 2);
        of_both += std::norm(found - exact[k]);
        size += std::norm(exact[k]);
    }
    return {std::sqrt(of_amplitude / size), std::sqrt(of_both / size)};
}

TEST(SoilColumn, SixCasesOfZienkiewiczInAmplitudeAndPhase) {
    // Bounds: 1.5 times what was measured; the last two cases have a boundary layer of less than a spacing.
    const std::array<std::pair<double, double>, 6> cases = {{{5.91e-5, 0.0033},
                                                             {5.91e-6, 0.0112},
                                                             {5.91e-7, 0.0034},
                                                             {5.91e-8, 0.0057},
                                                             {5.91e-9, 0.016},
                                                             {5.91e-10, 0.026}}};
    for (const auto& [permeability, bound] : cases) {
        const ColumnErrors errors = column_errors(permeability, 20);
        if (is_root()) fmt::print("| {} | {:.5f} | {:.5f} |\n", permeability, errors.amplitude, errors.both);
        EXPECT_LT(errors.both, bound) << permeability;
    }
}

TEST(SoilConsolidation, PressureFollowsTerzaghi) {
    const Communicator alone(MPI_COMM_SELF);
    const double stiffness = 30e6 * 0.8 / (1.2 * 0.6), storage = 1 / 333.3e6;
    const double coefficient = 1.0194e-7 / (1 / stiffness + storage);
    const double start = 5000 / stiffness / (1 / stiffness + storage);
    double worst = 0;
    run_soil(alone, soil_scene(alone, runs / "consolidation", {"run.end_time=12", "soil.spacing=0.5"}),
             [&](const SoilSimulation& simulation) {
                 if (simulation.time() < 10) return;  // T_v = 0.31
                 for (const std::size_t i : soil_nodes(simulation.particles())) {
                     const double depth = 10 - simulation.particles().data(field::position)[i];
                     double exact = 0;
                     for (int n = 0; n < 40; ++n)
                         exact +=
                             4 / pi * start / (2 * n + 1) * std::sin((2 * n + 1) * pi * depth / 20) *
                             std::exp(-std::pow((2 * n + 1) * pi, 2) * coefficient * simulation.time() / 400);
                     worst = std::max(
                         worst,
                         std::abs(simulation.particles().data(soil_field::pore_pressure)[i] - exact) / start);
                 }
             });
    if (is_root()) fmt::print("largest error {:.2e} of the first pressure\n", worst);
    EXPECT_LT(worst, 2e-3);
}

/// Direction of the strain between the weak spot and the other side against the lesser stress, and its most.
struct Band {
    double angle, strain;
};

Band saturated_band(double permeability, const std::string& dilation) {
    const Communicator comm(MPI_COMM_WORLD);
    Band band{};
    std::vector<std::string> overrides{"soil.spacing=0.04", "run.end_time=0.2"};
    for (const std::string material : {"sand", "weak"}) {
        overrides.push_back(fmt::format("materials.{}.permeability={}", material, permeability));
        overrides.push_back(fmt::format("materials.{}.yield.dilation_angle={}", material, dilation));
    }
    run_soil(comm, soil_scene(comm, runs / "saturated_shear_band", overrides),
             [&](const SoilSimulation& run) {
                 if (run.time() < 0.2) return;
                 band = {band_angle(comm, run), run.totals().greatest_viscoplastic_strain};
             });
    if (is_root())
        fmt::print("permeability {}, dilation {}: band at {:.2f} degrees, strain {:.4f}\n", permeability,
                   dilation, band.angle, band.strain);
    return band;
}

// Without drainage the soil keeps its volume, as clay without friction does: 45 degrees. Drained it is that
// of the friction, if that is also the angle of dilation. Sand that must dilate and cannot drain sucks itself
// together instead: J. R. Rice, J. Geophys. Res. 80 (1975) 1531.
TEST(SoilBand, WaterDecidesItsAngleAndWhetherItForms) {
    EXPECT_NEAR(saturated_band(1e-12, "0").angle, 45, 3);
    const Band drained = saturated_band(1e-5, "28 deg");
    EXPECT_NEAR(drained.angle, 45 + 28.0 / 2, 3);
    EXPECT_LT(saturated_band(1e-12, "28 deg").strain, 0.25 * drained.strain);
}

}  // namespace
}  // namespace talus::test
