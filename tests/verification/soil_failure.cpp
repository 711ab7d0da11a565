#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "domain/soil_fields.hpp"
#include "tests/support/soil_run.hpp"

/// Failure of soil against limit analysis, and the checkerboard that elements do not see.
namespace talus::test {
namespace {

const std::filesystem::path runs = std::filesystem::path(TALUS_SOURCE_DIR) / "runs";

bool is_root() { return Communicator(MPI_COMM_WORLD).is_root(); }

TEST(SoilCut, StabilityFactorOfAVerticalCut) {
    // D. W. Taylor and W. Fellenius: 0.261; bounds of limit analysis around 0.2648 (N = 3.776); T. Blanc and
    // M. Pastor report 0.253 by Taylor-SPH. Failure: the kinetic energy passes 100 J/m, a thousand times that
    // of the creep.
    const Communicator comm(MPI_COMM_WORLD);
    double yield_stress = 0;
    run_soil(comm, soil_scene(comm, runs / "vertical_cut", {"soil.spacing=1", "run.end_time=12.5"}),
             [&](const SoilSimulation& simulation) {
                 if (simulation.time() < 8 || simulation.step_count() % 10 != 0 || yield_stress > 0) return;
                 if (simulation.totals().kinetic_energy > 100)
                     yield_stress = 200e3 * simulation.setup().strength_factor(simulation.time());
             });
    const double factor = yield_stress / (std::sqrt(3.0) * 2000 * 9.81 * 10);
    if (is_root())
        fmt::print("yield stress at failure {:.0f} Pa, stability factor {:.4f}\n", yield_stress, factor);
    EXPECT_NEAR(factor, 0.253, 0.05 * 0.253);
}

TEST(SoilFooting, LimitLoadOfPrandtl) {
    // The stress under the footing's edge is singular: the error falls with the spacing.
    const Communicator comm(MPI_COMM_WORLD);
    const double exact = (2 + std::numbers::pi) / std::sqrt(3.0) * 15e3;  // half of a footing 2 m wide
    std::array<double, 2> errors{};
    for (const bool quick : {true, false}) {
        double force = 0;
        run_soil(comm, soil_scene(comm, runs / "strip_footing", {}, quick),
                 [&](const SoilSimulation& simulation) {
                     if (simulation.time() > 14.9 && force == 0) force = simulation.totals().forces[3][1];
                 });
        errors[quick ? 0 : 1] = 1 - force / exact;
        if (is_root()) fmt::print("limit load {:.0f} N/m of {:.0f}\n", 2 * force, 2 * exact);
    }
    EXPECT_LT(errors[0], 0.11);
    EXPECT_GT(errors[1], 0);
    EXPECT_LT(errors[1], 0.05);
    EXPECT_LT(errors[1], 0.6 * errors[0]) << "half the spacing";
}

TEST(SoilBlock, CheckerboardVelocityDecays) {
    // Elements see nothing of it; without the filter it stays for ever.
    const Communicator alone(MPI_COMM_SELF);
    for (const bool filtered : {true, false}) {
        SoilScene scene = soil_scene(alone, runs / "vertical_cut",
                                     {"soil.spacing=1", "soil.damping=0", "soil.gravity=[0, 0]",
                                      "soil.stress_smoothing=0", "materials.clay.yield.yield_stress=1e12",
                                      fmt::format("soil.hourglass={}", filtered ? 0.05 : 0.0)});
        scene.simulation.conditions.clear();
        ParticleSet soil = make_soil(alone, scene);
        double before = 0, after = 0;
        for (const std::size_t i : soil_nodes(soil)) {
            const long x = std::lround(soil.data(field::position, 0)[i]),
                       y = std::lround(soil.data(field::position, 1)[i]);
            soil.data(soil_field::velocity, 0)[i] = (x + y) % 2 == 0 ? 1 : -1;
            soil.data(soil_field::conditions)[i] = 0;
        }
        SoilSimulation simulation(alone, scene.simulation, std::move(soil));
        simulation.start();
        before = simulation.totals().kinetic_energy;
        for (int k = 0; k < 200; ++k) simulation.step();
        after = simulation.totals().kinetic_energy;
        if (is_root()) fmt::print("{} of the energy is left after 200 steps\n", after / before);
        if (filtered)
            EXPECT_LT(after, 1e-4 * before);  // 0.95^400 = 1e-9 within, more on faces
        else
            EXPECT_GT(after, 0.1 * before);
    }
}

TEST(SoilBand, AngleIsThatOfTheFrictionOnTwoLattices) {
    const Communicator comm(MPI_COMM_WORLD);
    for (const double spacing : {0.04, 0.02667}) {
        double angle = 0;
        const double fits = spacing > 0.03 ? 0.04 : 0.8 / 30;
        run_soil(
            comm,
            soil_scene(comm, runs / "shear_band",
                       {fmt::format("soil.spacing={}", fits), "run.end_time=0.2", "body[0].lower=[0, 0.56]",
                        fits < 0.03 ? "body[0].lower=[0, 0.53333333333333333]" : "seed=1",
                        fits < 0.03 ? "body[0].upper=[0.08, 0.64]" : "seed=1"}),
            [&](const SoilSimulation& simulation) {
                if (simulation.time() > 0.199 && angle == 0) angle = band_angle(comm, simulation);
            });
        if (is_root()) fmt::print("spacing {:.4f} m: band at {:.2f} degrees\n", fits, angle);
        EXPECT_NEAR(angle, 45 + 28.0 / 2, 3);
    }
}

}  // namespace
}  // namespace talus::test
