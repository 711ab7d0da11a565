#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/solid_scene.hpp"

/// runs/rubber_rings: they bounce, whole and without clumps. J. P. Gray, J. J. Monaghan, R. P. Swift, Comput.
/// Methods Appl. Mech. Eng. 190 (2001) 6641, whose standard SPH needs an artificial stress for that.
namespace talus::test {
namespace {

struct Rings {
    std::array<double, 2> velocity;  ///< of the centres of mass along x
    double gap;                      ///< between them along x
    double nearest, loneliest;       ///< least and greatest distance to the nearest partner of the own ring
};

Rings measure(const Simulation& run) {
    const auto x = on_every_rank(run, field::position, 0), y = on_every_rank(run, field::position, 1),
               u = on_every_rank(run, field::velocity, 0);
    const auto body = on_every_rank(run, field::body);
    Rings rings{{0, 0}, 0, std::numeric_limits<double>::infinity(), 0};
    std::array<double, 2> count{};
    double left = -std::numeric_limits<double>::infinity(), right = -left;
    for (std::size_t i = 0; i < x.size(); ++i) {
        rings.velocity[body[i]] += u[i];
        count[body[i]] += 1;
        (body[i] == 0 ? left : right) = body[i] == 0 ? std::max(left, x[i]) : std::min(right, x[i]);
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t j = 0; j < x.size(); ++j)
            if (i != j && body[i] == body[j]) least = std::min(least, std::hypot(x[i] - x[j], y[i] - y[j]));
        rings.nearest = std::min(rings.nearest, least);
        rings.loneliest = std::max(rings.loneliest, least);
    }
    for (std::size_t b = 0; b < 2; ++b) rings.velocity[b] /= count[b];
    rings.gap = right - left;
    return rings;
}

TEST(RubberRings, BounceWholeAndWithoutClumps) {
    const Communicator comm = world();
    const SceneSetup scene = solid_scene(comm, "rubber_rings");
    const double spacing = scene.bodies[0].spacing, speed = scene.bodies[0].velocity[0];
    const auto run = started(comm, scene);
    const double energy = run->totals().kinetic_energy;
    double nearest = 1, loneliest = 1, least_gap = 2;
    for (double look = 10; look <= scene.output.end_time; look += 10) {
        while (run->time() < look) run->step();
        const Rings now = measure(*run);
        nearest = std::min(nearest, now.nearest / spacing);
        loneliest = std::max(loneliest, now.loneliest / spacing);
        least_gap = std::min(least_gap, now.gap / spacing);
    }
    const Rings end = measure(*run);
    const Totals totals = run->totals();
    if (comm.is_root())
        fmt::print("| {:g} | {:.2f} | {:.3f} | {:.2f} .. {:.2f} | {:.1f} | {:.1e} |\n", spacing,
                   -end.velocity[0] / speed, totals.kinetic_energy / energy, nearest, loneliest,
                   end.gap / spacing, (totals.kinetic_energy + totals.internal_energy) / energy - 1);

    // A ring keeps part of the energy as vibration and loses some to the Riemann problems' dissipation;
    // published pictures show them leave at about half their speed.
    EXPECT_LT(end.velocity[0], -0.3 * speed);
    EXPECT_GT(end.velocity[1], 0.3 * speed);
    EXPECT_GT(end.gap, 2 * spacing) << "the rings stick together";
    EXPECT_GT(least_gap, 0.5) << "the rings pass through each other";
    // Clumps are pairs at a fraction of the spacing. A crack would stay: in the end everyone has partners at
    // the spacing again. On the way a surface particle or two of the stepped outline, at the edge of the
    // contact, stand off by up to 1.4 spacings for a while (measured).
    EXPECT_GT(nearest, 0.6);
    EXPECT_LT(loneliest, 1.5);
    EXPECT_LT(end.loneliest, 1.1 * spacing);
    EXPECT_NEAR((totals.kinetic_energy + totals.internal_energy) / energy, 1, 1e-4) << "total energy";
}

}  // namespace
}  // namespace talus::test
