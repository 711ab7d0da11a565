#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "domain/soil_fields.hpp"
#include "tests/support/soil_run.hpp"

/// Soil in large deformation: motion without strain, free surfaces, tension, failure.
namespace talus::test {
namespace {

const std::filesystem::path runs = std::filesystem::path(TALUS_SOURCE_DIR) / "runs";
bool is_root() { return Communicator(MPI_COMM_WORLD).is_root(); }

/// An elastic block in nothing: 10 x 4 m, waves of 232 m/s.
SoilScene block(const Communicator& comm, const std::vector<std::string>& more = {}) {
    std::vector<std::string> overrides{"soil.deformation=large",
                                       "soil.spacing=0.5",
                                       "soil.damping=0",
                                       "soil.gravity=[0, 0]",
                                       "materials.clay.yield.yield_stress=1e12",
                                       "body[0].lower=[-5,-2]",
                                       "body[0].upper=[0,2]",
                                       "body[1].lower=[0,-2]",
                                       "body[1].upper=[5,2]",
                                       "boundary[2].lower=[5,-2]"};
    overrides.insert(overrides.end(), more.begin(), more.end());
    SoilScene scene = soil_scene(comm, runs / "vertical_cut", overrides);
    return scene;
}

SoilSimulation moving(const Communicator& comm, const SoilScene& scene,
                      const std::function<std::array<double, 2>(double, double)>& velocity) {
    ParticleSet soil = make_soil(comm, scene);
    for (std::size_t i = 0; i < soil.size(); ++i) {
        const auto v = velocity(soil.data(field::position, 0)[i], soil.data(field::position, 1)[i]);
        for (int a = 0; a < 2; ++a) soil.data(soil_field::velocity, a)[i] = v[static_cast<std::size_t>(a)];
        soil.data(soil_field::conditions)[i] = 0;
    }
    SoilSetup setup = scene.simulation;
    setup.conditions.clear();
    return SoilSimulation(comm, setup, std::move(soil));
}

double spin_of(const ParticleSet& soil) {
    double sum = 0;
    for (const std::size_t i : soil_nodes(soil))
        sum += soil.data(field::mass)[i] *
               (soil.data(field::position, 0)[i] * soil.data(soil_field::velocity, 1)[i] -
                soil.data(field::position, 1)[i] * soil.data(soil_field::velocity, 0)[i]);
    return sum;
}

double greatest_stress(const ParticleSet& soil) {
    double greatest = 0;
    for (const std::size_t i : soil_nodes(soil))
        for (int c = 0; c < 3; ++c)
            greatest = std::max(greatest, std::abs(soil.data(soil_field::stress, c)[i]));
    return greatest;
}

TEST(SoilInMotion, TranslationMakesNoStress) {
    const Communicator alone(MPI_COMM_SELF);
    SoilSimulation run = moving(alone, block(alone), [](double, double) { return std::array{20.0, -7.0}; });
    run.start();
    for (int k = 0; k < 1000; ++k) run.step();
    EXPECT_NEAR(run.totals().greatest_displacement, std::hypot(20, 7) * run.time(), 1e-9);
    EXPECT_LT(greatest_stress(run.particles()), 1e-9 * 8e7);  // of rounding
}

TEST(SoilInMotion, ARotatingBlockKeepsItsSpinShapeAndEnergy) {
    // Ten turns at 3 rad/s. The stress of a bar that turns is rho w^2 L^2/2 in its middle; let go at once it
    // swings to twice that. Jaumann's rate with explicit steps would have grown by exp(w^2 dt t/2) = 1.06.
    const Communicator alone(MPI_COMM_SELF);
    const double spin = 3, centrifugal = 0.5 * 2000 * std::pow(spin * 5, 2);
    SoilSimulation run = moving(alone, block(alone), [&](double x, double y) {
        return std::array{-spin * y, spin * x};
    });
    run.start();
    const double before = spin_of(run.particles()), energy = run.totals().kinetic_energy;
    double greatest = 0;
    while (run.time() < 10 * 2 * std::numbers::pi / spin) {
        run.step();
        if (run.step_count() % 50 == 0) greatest = std::max(greatest, greatest_stress(run.particles()));
    }
    const SoilTotals end = run.totals();
    if (is_root())
        fmt::print("spin {:.6f}, energy {:.6f} of the start, stress {:.2f} then {:.2f} of the centrifugal\n",
                   spin_of(run.particles()) / before, (end.kinetic_energy + end.elastic_energy) / energy,
                   greatest / centrifugal, greatest_stress(run.particles()) / centrifugal);
    EXPECT_NEAR(spin_of(run.particles()), before, 1e-3 * before);
    EXPECT_NEAR(end.kinetic_energy + end.elastic_energy, energy, 0.01 * energy);
    EXPECT_LT(greatest, 2.5 * centrifugal);
    EXPECT_NEAR(std::hypot(end.momentum[0], end.momentum[1]), 0, 1e-6 * end.mass * spin * 5);
}

TEST(SoilInMotion, CheckerboardVelocityDecays) {
    // Elements see nothing of it; of the energy 0.95^400 = 1e-9 would be left within.
    const Communicator alone(MPI_COMM_SELF);
    for (const bool filtered : {true, false}) {
        SoilSimulation run =
            moving(alone, block(alone, {fmt::format("soil.hourglass={}", filtered ? 0.05 : 0.0)}),
                   [&](double x, double y) {
                       const long k = std::lround(2 * x) + std::lround(2 * y);
                       return std::array{k % 2 == 0 ? 1.0 : -1.0, 0.0};
                   });
        run.start();
        const double before = run.totals().kinetic_energy;
        for (int k = 0; k < 200; ++k) run.step();
        const double after = run.totals().kinetic_energy;
        if (is_root()) fmt::print("{} of the energy is left after 200 steps\n", after / before);
        if (filtered)
            EXPECT_LT(after, 1e-4 * before);
        else
            EXPECT_GT(after, 0.1 * before);
    }
}

}  // namespace
}  // namespace talus::test
