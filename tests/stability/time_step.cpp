#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/support/lattice_simulation.hpp"
#include "tests/support/shared_cases.hpp"
#include "tests/support/stability_row.hpp"

/// The wall of the time step: kick-drift-kick bears waves up to omega dt = 2.
namespace talus::test {
namespace {

constexpr int length = 12;
double wavenumber(int mode) { return 2 * std::numbers::pi * mode / length; }

struct WaveCase {
    const char* name;
    LatticeCase lattice;
};

/// omega^2 of a mode by the linear theory of the formulation.
double theory(const LatticeCase& lattice, double k) {
    if (lattice.formulation == sph::Formulation::godunov) return omega_squared(lattice, k);
    const LatticeState state = lattice_state(lattice);
    return reference::standard_omega_squared({.dimension = lattice.dimension,
                                              .smoothing_length = lattice.smoothing_length,
                                              .density = state.density,
                                              .pressure = lattice.pressure * state.density,
                                              .cutoff = lattice.cutoff,
                                              .gradient_scale = state.kernel_scale},
                                             k);
}

/// The mode of the box that swings fastest.
int fastest_mode(const LatticeCase& lattice) {
    int fastest = 1;
    for (int mode = 2; mode <= length / 2; ++mode)
        if (theory(lattice, wavenumber(mode)) > theory(lattice, wavenumber(fastest))) fastest = mode;
    return fastest;
}

/// How much the fastest mode has grown after 60 steps of `share` of 2/omega.
double growth(const Communicator& comm, LatticeCase lattice, double share) {
    constexpr double amplitude = 1e-12;
    const double k = wavenumber(fastest_mode(lattice)), wall = 2 / std::sqrt(theory(lattice, k));
    lattice.courant = share * wall / lattice.smoothing_length;
    LatticeSimulation wave(
        comm, lattice,
        [&](std::uint64_t, const Point& site) {
            return Point{amplitude * std::sin(k * site[0]), 0, 0};
        },
        [](std::uint64_t, const Point&) { return Point{}; });
    double greatest = 0;
    for (int step = 0; step < 60 && greatest < 1e6 * amplitude; ++step) {
        EXPECT_NEAR(wave.run().time_step(), share * wall, 1e-3 * wall);
        wave.run().step();
        greatest = std::max(greatest, std::abs(wave.displacement(k)));
    }
    return greatest / amplitude;
}

/// Lattices of standard and Godunov SPH without dissipation, in 1D and 2D, compressed or stretched as far as
/// their formulation bears. Theory: omega dt = 2 for the leapfrog; at 0.95 of it the amplitude stays within
/// 1/sqrt(1 - 0.95^2) = 3.2 of the first, at 1.05 it grows 1.89 times a step.
TEST(TimeStep, TheWallOfTheLeapfrogStandsWhereTheDispersionRelationPutsIt) {
    LatticeCase standard{.formulation = sph::Formulation::standard,
                         .size = {length, 0, 0},
                         .pressure = 0.3,
                         .density = sph::DensityMethod::summation};
    LatticeCase godunov = standard, plane = standard;
    godunov.formulation = sph::Formulation::godunov;
    plane.dimension = 2;
    plane.size = {length, 5, 0};
    const std::vector<WaveCase> cases{
        {"standard, 1D", standard}, {"Godunov, 1D", godunov}, {"standard, 2D", plane}};
    const std::vector<double> shares{0.5, 0.8, 0.95, 1.05, 1.2};
    const auto found =
        on_shared_ranks(cases.size() * shares.size(), [&](const Communicator& comm, std::size_t c) {
            return growth(comm, cases[c / shares.size()].lattice, shares[c % shares.size()]);
        });
    for (std::size_t c = 0; c < found.size(); ++c) {
        const auto& [name, lattice] = cases[c / shares.size()];
        const double share = shares[c % shares.size()];
        if (share < 1)
            EXPECT_LT(found[c], 3.5) << name << ", " << share;
        else
            EXPECT_GT(found[c], 1e3) << name << ", " << share;
        if (is_root())
            print({"time step", name, "omega dt", 2 * share, 2, "growth", found[c], found[c] < 3.5});
    }
}

}  // namespace
}  // namespace talus::test
