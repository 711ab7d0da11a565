#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/scene_run.hpp"

namespace talus::test {
namespace {

constexpr double amplitude = 1e-5;  // of the velocity, sound speed 1: terms of its square are 1e-5 of it

/// Errors of velocity and density in units of the wave's amplitude.
struct WaveErrors {
    double velocity, density;
};

// Linear acoustics: v = A sin kx cos kt, rho = 1 - A cos kx sin kt. The summed density of the undisturbed
// lattice, 1 within 1e-4, is taken for 1.
WaveErrors wave_errors(const GasResult& gas) {
    const double k = 2 * std::numbers::pi, t = gas.time;
    double mean = 0;
    for (const double density : gas.density) mean += density / static_cast<double>(gas.density.size());
    const auto v_error = [&](std::size_t i) {
        return gas.v[i] / amplitude - std::sin(k * gas.x[i]) * std::cos(k * t);
    };
    const auto density_error = [&](std::size_t i) {
        return (gas.density[i] - mean) / amplitude + std::cos(k * gas.x[i]) * std::sin(k * t);
    };
    return {gas.mean_error(v_error, -1, 2), gas.mean_error(density_error, -1, 2)};
}

struct Method {
    const char* name;
    std::vector<std::string> overrides;
    WaveErrors finest;  ///< 1.15 times the errors measured with 128 particles
    double least_order;
};

/// Second order down to 1e-3 of the amplitude; the finite number of partners ends it at some 5e-4.
/// Viscosity as standard SPH needs it for shocks damps in first order.
TEST(AcousticWave, ConvergesInSecondOrder) {
    const Communicator comm(MPI_COMM_SELF);  // too small to share: every rank does the same
    const Method methods[] = {
        {"godunov", {}, {3.2e-3, 9.2e-4}, 1.9},
        {"standard, no viscosity",
         {"sph.formulation=\"standard\"", "sph.viscosity_alpha=0", "sph.viscosity_beta=0"},
         {1.1e-4, 1.9e-4},
         1.9},
        {"standard", {"sph.formulation=\"standard\""}, {3.8e-2, 4e-2}, 0.85},
    };
    for (const Method& method : methods) {
        std::vector<WaveErrors> errors;
        for (const int n : {32, 64, 128}) {
            std::vector<std::string> overrides = method.overrides;
            overrides.push_back(fmt::format("body[0].particles={}", n));
            const GasResult gas =
                run_gas(comm, std::filesystem::path(TALUS_SOURCE_DIR) / "runs/acoustic_wave", overrides);
            EXPECT_LT(gas.energy_drift, 1e-13);
            errors.push_back(wave_errors(gas));
            if (Communicator(MPI_COMM_WORLD).is_root())
                fmt::print("| {} | {} | {:.2e} | {:.2e} |\n", method.name, n, errors.back().velocity,
                           errors.back().density);
        }
        EXPECT_LT(errors.back().velocity, method.finest.velocity) << method.name;
        EXPECT_LT(errors.back().density, method.finest.density) << method.name;
        EXPECT_GT(order_of(errors.front().velocity, errors.back().velocity) / 2, method.least_order)
            << method.name;
        EXPECT_GT(order_of(errors.front().density, errors.back().density) / 2, method.least_order)
            << method.name;
    }
}

}  // namespace
}  // namespace talus::test
