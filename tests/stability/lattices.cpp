#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/support/lattice_simulation.hpp"
#include "tests/support/shared_cases.hpp"
#include "tests/support/stability_row.hpp"

/// Lattices that pair, and velocities that no stress sees.
namespace talus::test {
namespace {

/// A compressed face-centred lattice under standard SPH with so many partners within the kernel's support 2
/// h.
LatticeCase packed(sph::KernelKind kernel, double partners) {
    const double edge = std::cbrt(4.0);
    return {.formulation = sph::Formulation::standard,
            .kernel = kernel,
            .dimension = 3,
            .size = {4 * edge, 4 * edge, 4 * edge},
            .lattice = Lattice::close_packed,
            .pressure = 0.6,  // of an ideal gas of gamma 5/3
            .smoothing_length = 0.5 * std::cbrt(partners * 3 / (4 * std::numbers::pi)),
            .density = sph::DensityMethod::summation,
            .courant = 0.3};
}

/// The cubic spline pairs beyond 50 to 55 partners, Wendland's kernels do not: W. Dehnen, H. Aly, MNRAS 425
/// (2012) 1068, sections 3 and 4. A paired particle is nearer to its partner than half the lattice's
/// distance.
TEST(Pairing, TheCubicSplinePairsBeyondFiftyPartnersAndWendlandsKernelDoesNot) {
    struct Case {
        const char* name;
        sph::KernelKind kernel;
        double partners;
        bool stable;
    };
    const std::vector<Case> cases{{"cubic spline", sph::KernelKind::cubic_spline, 42, true},
                                  {"cubic spline", sph::KernelKind::cubic_spline, 50, true},
                                  {"cubic spline", sph::KernelKind::cubic_spline, 58, false},
                                  {"cubic spline", sph::KernelKind::cubic_spline, 70, false},
                                  {"cubic spline", sph::KernelKind::cubic_spline, 100, false},
                                  {"Wendland C4", sph::KernelKind::wendland_c4, 70, true},
                                  {"Wendland C4", sph::KernelKind::wendland_c4, 100, true}};
    const auto closest = on_shared_ranks(cases.size(), [&](const Communicator& comm, std::size_t c) {
        return closest_after(comm, packed(cases[c].kernel, cases[c].partners), 30);
    });
    for (std::size_t c = 0; c < cases.size(); ++c) {
        const auto& [name, kernel, partners, stable] = cases[c];
        if (stable)
            EXPECT_GT(closest[c], 0.8) << name << ", " << partners;
        else
            EXPECT_LE(closest[c], 0.5) << name << ", " << partners;
        if (is_root())
            print({"pairing", name, "partners", partners,
                   kernel == sph::KernelKind::cubic_spline ? 55.0 : INFINITY, "closest pair", closest[c],
                   closest[c] > 0.8});
    }
}

/// Velocities of alternating sign along x on a cubic lattice without pressure: every gradient is zero, so
/// that standard SPH without viscosity never feels them. Riemann problems between the particles do, and take
/// them away.
TEST(Hourglass, RiemannProblemsTakeAwayWhatNoGradientSees) {
    constexpr double speed = 1e-6, crossings = 1;
    LatticeCase godunov{.dimension = 2,
                        .size = {12, 6, 0},
                        .density = sph::DensityMethod::continuity,
                        .riemann = true,
                        .courant = 0.2};
    LatticeCase standard = godunov, mean = godunov;
    standard.formulation = sph::Formulation::standard;
    mean.riemann = false;
    const std::vector<LatticeCase> cases{godunov, mean, standard};
    const auto left = on_shared_ranks(cases.size(), [&](const Communicator& comm, std::size_t c) {
        LatticeSimulation box(
            comm, cases[c], [](std::uint64_t, const Point&) { return Point{}; },
            [](std::uint64_t, const Point& site) {
                return Point{std::fmod(std::floor(site[0]) + std::floor(site[1]), 2) == 0 ? speed : -speed, 0,
                             0};
            });
        const double before = box.run().totals().kinetic_energy;
        while (box.run().time() < crossings * cases[c].size[0]) box.run().step();
        return box.run().totals().kinetic_energy / before;
    });
    EXPECT_LT(left[0], 0.01);
    EXPECT_GT(left[1], 0.99);
    EXPECT_GT(left[2], 0.99);
    if (is_root())
        for (std::size_t c = 0; c < cases.size(); ++c)
            print({"hourglass",
                   c == 0   ? "Godunov"
                   : c == 1 ? "Godunov, mean pressure"
                            : "standard",
                   "crossings", crossings, INFINITY, "kinetic energy left", left[c], left[c] < 0.5});
}

}  // namespace
}  // namespace talus::test
