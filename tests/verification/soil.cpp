#include <fmt/format.h>
#include <gtest/gtest.h>
#include <mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tests/support/solid_scene.hpp"

/// Soil and water between walls of particles: at rest, sliding, collapsing.
namespace talus::test {
namespace {

constexpr double gravity = 9.81;

/// Of the matter (body 0) of a scene, on every rank.
struct Matter {
    std::vector<double> x, y, u, v, pressure, density, s_xx, s_yy;

    explicit Matter(const Simulation& run) {
        const auto body = on_every_rank(run, field::body);
        const auto take = [&](const Field<double>& field, int component) {
            std::vector<double> all = on_every_rank(run, field, component), mine;
            for (std::size_t i = 0; i < all.size(); ++i)
                if (body[i] == 0) mine.push_back(all[i]);
            return mine;
        };
        x = take(field::position, 0);
        y = take(field::position, 1);
        u = take(field::velocity, 0);
        v = take(field::velocity, 1);
        pressure = take(field::pressure, 0);
        density = take(field::predicted_density, 0);
        if (!run.particles().has(field::predicted_stress)) return;
        s_xx = take(field::predicted_stress, 0);
        s_yy = take(field::predicted_stress, 1);
    }
    double shear(std::size_t i) const { return s_yy.empty() ? 0 : s_yy[i]; }
};

/// Greatest over time of the rms error of the vertical stress over rho g H, and the mean lateral over
/// vertical stress.
struct Rest {
    double error = 0, ratio = 0, drift = 0;
};

/// Small: every rank computes it for itself.
Rest rest(const std::vector<std::string>& overrides) {
    const Communicator comm(MPI_COMM_SELF);
    const SceneSetup scene = solid_scene(comm, "soil_at_rest", overrides);
    const auto run = started(comm, scene);
    const double weight = scene.bodies[0].density * gravity;
    Rest found;
    const Matter first(*run);
    for (double look = 0.05; look <= 0.5; look += 0.05) {
        while (run->time() < look) run->step();
        const Matter now(*run);
        double square = 0, lateral = 0, vertical = 0;
        for (std::size_t i = 0; i < now.y.size(); ++i) {
            const double stress = now.pressure[i] - now.shear(i);
            square += std::pow(stress / weight - (1 - now.y[i]), 2);
            vertical += stress;
            lateral += now.pressure[i] - (now.s_xx.empty() ? 0 : now.s_xx[i]);
            found.drift =
                std::max({found.drift, std::abs(now.x[i] - first.x[i]), std::abs(now.y[i] - first.y[i])});
        }
        found.error = std::max(found.error, std::sqrt(square / static_cast<double>(now.y.size())));
        found.ratio = lateral / vertical;
    }
    if (world().is_root())
        fmt::print("vertical stress to {:.4f} of rho g H, K0 = {:.4f}, moved {:.1e} m\n", found.error,
                   found.ratio, found.drift);
    return found;
}

TEST(SoilAtRest, KeepsTheStressOfItsWeight) {
    // Ten periods of the column's first mode, 4 H/c_L = 0.049 s. The cone of the scene bears K0 >= (root 3 -
    // f)/(root 3 + 2 f), f = sin 30 deg, in uniaxial strain (tau = (1 - K0) sigma/root 3, p = (1 + 2 K0)
    // sigma/3), elasticity wants less.
    const double f = 0.5, least = (std::sqrt(3.0) - f) / (std::sqrt(3.0) + 2 * f);
    for (const char* formulation : {"godunov", "standard"}) {
        const Rest found = rest({fmt::format("sph.formulation={}", formulation)});
        EXPECT_LT(found.error, 0.02) << "20 rows of particles";
        EXPECT_NEAR(found.ratio, least, 0.01);
        EXPECT_LT(found.drift, 0.02 * 0.05) << "of a spacing";
    }
}

TEST(SoilAtRest, ElasticSoilHasTheRatioOfHooke) {
    const Rest found = rest({"sph.formulation=standard", "materials.sand.poisson_ratio=0.4"});
    EXPECT_LT(found.error, 0.02);
    EXPECT_NEAR(found.ratio, 0.4 / 0.6, 0.01);
}

TEST(WallsOfParticles, HoldWaterAsWell) {
    const Rest found =
        rest({"materials.sand={density=1000,equation_of_state={kind=\"linear\",sound_"
              "speed=30},least_pressure=0}"});
    EXPECT_LT(found.error, 0.02);
    EXPECT_NEAR(found.ratio, 1, 1e-12);
    // A lattice of water need not stay one, but none of it may get between particles of a wall.
    EXPECT_LT(found.drift, 0.25 * 0.05) << "of a spacing";
}

TEST(WallsOfParticles, DoNotHoldBackWhatSlips) {
    // An elastic block on a slope without friction: u = g_x t.
    const Communicator alone(MPI_COMM_SELF);
    const SceneSetup scene = solid_scene(
        alone, "column_collapse",
        {"sph.gravity=[2.5,-9.5]", "body[1].wall=free_slip", "body[1].normal=[0,1]",
         "body[0].geostatic.surface=-1", "body[0].lower=[0.05,0]", "materials.bars.strength.cohesion=1e6"});
    const auto run = started(alone, scene);
    while (run->time() < 0.1) run->step();
    const Matter block(*run);
    double mean = 0, lowest = 1;
    for (const double u : block.u) mean += u / static_cast<double>(block.u.size());
    for (const double y : block.y) lowest = std::min(lowest, y);
    EXPECT_NEAR(mean, 2.5 * run->time(), 0.005 * mean);
    EXPECT_GT(lowest, 0);
}

TEST(ColumnCollapse, RunsOutAsColumnsOfSandDo) {
    // a = 2: run-out over length from 2.4 to 3.6, height over length from 0.8 to 1.7, around E. Lajeunesse,
    // J. B. Monnier, G. M. Homsy, Phys. Fluids 17 (2005) 103302, and G. Lube et al., Phys. Rev. E 72 (2005)
    // 041301.
    const Communicator comm = world();
    const SceneSetup scene = solid_scene(comm, "column_collapse",
                                         {"body[0].upper=[0.1,0.2]", "body[2].upper=[0,0.25]",
                                          "materials.bars.strength.friction_angle=31 deg"});
    const auto run = started(comm, scene);
    const double length = 0.1, spacing = scene.bodies[0].spacing;
    const Totals before = run->totals();
    while (run->time() < 0.6) run->step();
    const Totals after = run->totals();
    const Matter end(*run);
    std::vector<double> column(200, 0);  // heights, in strips of two spacings
    const double strip = 2 * spacing;
    for (const double x : end.x)
        column[static_cast<std::size_t>(std::max(0.0, x) / strip)] += spacing * spacing / strip;
    const auto thin =
        std::find_if(column.begin(), column.end(), [&](double h) { return h < 0.75 * spacing; });
    const double run_out = strip * static_cast<double>(thin - column.begin()) / length - 1;
    const double height = (*std::max_element(end.y.begin(), end.y.end()) + spacing / 2) / length;
    const auto [least, greatest] = std::minmax_element(end.density.begin(), end.density.end());
    double speed2 = 0;
    for (std::size_t i = 0; i < end.u.size(); ++i) speed2 += end.u[i] * end.u[i] + end.v[i] * end.v[i];
    const double speed = std::sqrt(speed2 / static_cast<double>(end.u.size()));
    if (world().is_root())
        fmt::print("run-out {:.2f}, height {:.2f}, rms speed {:.4f} m/s, density {:.0f} to {:.0f}\n", run_out,
                   height, speed, *least, *greatest);
    EXPECT_GT(run_out, 2.4);
    EXPECT_LT(run_out, 3.6);
    EXPECT_GT(height, 0.8);
    EXPECT_LT(height, 1.7);
    EXPECT_LT(speed, 0.03 * std::sqrt(gravity * 0.2)) << "it has come to rest";
    EXPECT_GT(*std::min_element(end.y.begin(), end.y.end()), 0) << "nothing sinks into the floor";
    EXPECT_GT(*std::min_element(end.x.begin(), end.x.end()), 0);
    EXPECT_GT(*least, 0.99 * 2650);
    EXPECT_LT(*greatest, 1.02 * 2650);
    // What the column loses by falling becomes heat: friction takes energy and gives none.
    const double released = before.potential_energy - after.potential_energy;
    EXPECT_GT(released, 0.3 * before.potential_energy);
    EXPECT_NEAR(after.total_energy(), before.total_energy(), 0.05 * released);
    EXPECT_GT(after.internal_energy - before.internal_energy, 0.9 * released);
}

}  // namespace
}  // namespace talus::test
