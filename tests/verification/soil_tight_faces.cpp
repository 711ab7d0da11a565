#include <fmt/format.h>
#include <gtest/gtest.h>
#include <mpi.h>

#include <cmath>
#include <vector>

#include "domain/soil_fields.hpp"
#include "tests/support/scene_run.hpp"
#include "tests/support/soil_run.hpp"

/// Soil with water in its pores: what holds whatever the permeability.
namespace talus::test {
namespace {

const std::filesystem::path runs = std::filesystem::path(TALUS_SOURCE_DIR) / "runs";

TEST(SaturatedSoil, LoadedThroughATightFaceTheWaterBearsItsShare) {
    // Undrained and damped, uniaxial: p = load Q / (Q + M), M of the drained soil. The node on the face errs
    // by an element's share.
    const Communicator alone(MPI_COMM_SELF);
    const double stiffness = 30e6 * 0.8 / (1.2 * 0.6), water = 333.3e6;
    const double exact = 5e3 * water / (water + stiffness);
    std::vector<double> errors;
    for (const double spacing : {0.5, 0.25}) {
        const SoilScene scene = soil_scene(
            alone, runs / "consolidation",
            {"boundary[2].kind=traction", "boundary[2].traction=[-5e3]", "boundary[1].traction=[-5e3]",
             "materials.soil.permeability=1e-4", fmt::format("soil.spacing={}", spacing), "run.end_time=2"});
        double mean = 0, fastest = 0;
        run_soil(alone, scene, [&](const SoilSimulation& simulation) {
            if (simulation.time() < 2) return;
            const ParticleSet& particles = simulation.particles();
            const std::vector<std::size_t> nodes = soil_nodes(particles);
            for (const std::size_t i : nodes)
                mean += particles.data(soil_field::pore_pressure)[i] / static_cast<double>(nodes.size());
            fastest = simulation.totals().greatest_speed;
        });
        EXPECT_LT(fastest, 1e-6);
        errors.push_back(std::abs(mean / exact - 1));
    }
    fmt::print("water's share of the load: errors {:.2g} and {:.2g}\n", errors[0], errors[1]);
    EXPECT_LT(errors[1], 0.25 / 10) << "an element of the length";
    EXPECT_LT(errors[1], 0.6 * errors[0]);
}

TEST(SaturatedSoil, PressureAnswersAlikeBothWaysWherePermeabilityJumps) {
    // The matrix is symmetric: what a source at one node makes at another is what it would make the other way
    // round. Sources are pressures before the step, times volume and storage.
    const Communicator alone(MPI_COMM_SELF);
    const std::string other = "density=2000,youngs_modulus=1e7,poisson_ratio=0.2,mixture_stiffness=1e9";
    const SoilScene scene = soil_scene(
        alone, runs / "saturated_stratum",
        {"soil.pressure_smoothing=0.3",
         "body=[{name=\"a\",material=\"soil\",shape=\"box\",lower=[0,0],upper=[2,1]},"
         "{name=\"b\",material=\"b\",shape=\"box\",lower=[0,1],upper=[2,2]}]",
         "materials.soil.permeability=1e-3", "materials.soil.mixture_stiffness=1e9",
         "materials.b={permeability=1e-10," + other + "}", "soil.spacing=0.5", "boundary[0].upper=[1,5]"});
    const auto response = [&](std::uint64_t source, std::uint64_t at) {
        SoilSimulation simulation(alone, scene.simulation, make_soil(alone, scene));
        simulation.start();
        ParticleSet& particles = simulation.particles();
        const auto find = [&](std::uint64_t id) {
            std::size_t i = 0;
            while (particles.data(field::id)[i] != id) ++i;
            return i;
        };
        const std::size_t from = find(source);
        particles.data(soil_field::pore_pressure)[from] = 1e5 / particles.data(soil_field::volume)[from];
        simulation.step();
        EXPECT_LT(simulation.pressure_iterations(), 200);
        return particles.data(soil_field::pore_pressure)[find(at)];
    };
    // Nodes of five a row, two and three rows up, below and above the jump.
    for (const auto& [one, two] : {std::pair{7, 12}, {6, 13}, {5, 11}, {12, 17}}) {
        const double there = response(one, two), back = response(two, one);
        EXPECT_GT(std::abs(there), 1e-3);
        EXPECT_NEAR(there, back, 1e-6 * std::abs(there)) << one << " " << two;
    }
}

}  // namespace
}  // namespace talus::test
