#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support/hugoniot.hpp"
#include "tests/support/solid_scene.hpp"

/// runs/planar_impact: the plateau between the two shocks against the Rankine-Hugoniot relations.
namespace talus::test {
namespace {

struct Case {
    std::string material;
    double speed;  ///< at which the slabs meet [m/s]
    int order;
};

struct Plateau {
    double pressure, density, front;  ///< means between impact plane and shock; place of the shock
    double spread;                    ///< root mean square deviation of the pressure, relative
    double heated;                    ///< how far from the impact plane the density deviates by 2 %
};

/// Averages from 0.4 to 0.8 of the way to the shock, which is where half of the plateau's pressure is
/// reached.
Plateau measure(const Simulation& run) {
    const auto x = on_every_rank(run, field::position), P = on_every_rank(run, field::pressure),
               rho = on_every_rank(run, field::predicted_density);
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < x.size(); ++i)
        if (x[i] > 0) order.push_back(i);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return x[a] < x[b]; });
    std::size_t last = order.size() - 1;
    const double half = 0.5 * P[order[order.size() / 50]];
    while (last > 0 && P[order[last - 1]] < half) --last;
    const std::size_t above = order[last - 1], below = order[last];
    Plateau result{};
    result.front = x[above] + (x[below] - x[above]) * (P[above] - half) / (P[above] - P[below]);
    double count = 0, square = 0;
    for (const std::size_t i : order)
        if (x[i] > 0.4 * result.front && x[i] < 0.8 * result.front) {
            count += 1;
            result.pressure += P[i];
            result.density += rho[i];
            square += P[i] * P[i];
        }
    result.pressure /= count;
    result.density /= count;
    result.spread =
        std::sqrt(std::max(0.0, square / count - result.pressure * result.pressure)) / result.pressure;
    for (const std::size_t i : order)
        if (x[i] < 0.4 * result.front && std::abs(rho[i] / result.density - 1) > 0.02) result.heated = x[i];
    return result;
}

/// The error is the scheme's own and does not shrink with the spacing, since shocks are always a few
/// particles wide: at most 0.5 % is found.
constexpr double tolerance = 0.01;

class PlanarImpact : public testing::TestWithParam<Case> {};

TEST_P(PlanarImpact, PlateauFollowsTheHugoniot) {
    const Communicator comm = world();
    const Case& impact = GetParam();
    std::vector<std::string> overrides{fmt::format("sph.order={}", impact.order)};
    for (int b = 0; b < 2; ++b) {
        overrides.push_back(fmt::format("body[{}].material={}_hydrodynamic", b, impact.material));
        overrides.push_back(fmt::format("body[{}].velocity=[{}]", b, (0.5 - b) * impact.speed));
    }
    const SceneSetup scene = solid_scene(comm, "planar_impact", overrides);
    const Material& material = scene.simulation.materials[0];
    const ShockState exact = symmetric_impact(material.eos, material.reference_density, 0, impact.speed);
    const double through = volume(scene.bodies[0].shape, 1) / exact.shock_speed;  // the slab [s]

    const auto run = started(comm, scene);
    while (run->time() < 0.3 * through) run->step();
    const double front = measure(*run).front, time = run->time();
    while (run->time() < 0.6 * through) run->step();
    const Plateau found = measure(*run);
    const double shock_speed = (found.front - front) / (run->time() - time) + impact.speed / 2;

    EXPECT_NEAR(found.pressure / exact.pressure, 1, tolerance);
    EXPECT_NEAR(found.density / exact.density, 1, tolerance);
    EXPECT_NEAR(shock_speed / exact.shock_speed, 1, tolerance);
    EXPECT_LT(found.spread, 0.01);
    const double spacing = scene.bodies[0].spacing * material.reference_density / exact.density;
    EXPECT_LT(found.heated, 12 * spacing) << "heated further than the start of the shock reaches";
    if (comm.is_root())
        fmt::print(
            "| {} | {:g} | {} | {:.2f} / {:.2f} | {:.0f} / {:.0f} | {:.4f} / {:.4f} | {:.1f} | {:.0f} |\n",
            impact.material, impact.speed / 1000, impact.order, found.pressure / 1e9, exact.pressure / 1e9,
            shock_speed, exact.shock_speed, found.density / material.reference_density,
            exact.density / material.reference_density, 100 * found.spread, found.heated / spacing);
}

INSTANTIATE_TEST_SUITE_P(All, PlanarImpact,
                         testing::Values(Case{"basalt", 1000, 2}, Case{"basalt", 5000, 2},
                                         Case{"basalt", 10000, 2}, Case{"basalt", 10000, 1},
                                         Case{"aluminium", 1000, 2}, Case{"aluminium", 5000, 2},
                                         Case{"aluminium", 10000, 2}),
                         [](const testing::TestParamInfo<Case>& which) {
                             return fmt::format("{}_{}_order_{}", which.param.material, which.param.speed,
                                                which.param.order);
                         });

}  // namespace
}  // namespace talus::test
