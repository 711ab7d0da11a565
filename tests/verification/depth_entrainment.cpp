#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "tests/support/depth_run.hpp"

/// Entrainment against closed forms: with Hungr's law the volume is V_0 exp(E s) after a way s.
namespace talus::test {
namespace {

constexpr double gravity = 9.81, growth = 0.02, speed = 5;

/// A heap, or an even layer without end, on a plane.
DepthScene frictionless(int dimension, bool is_layer, double slope) {
    DepthScene scene;
    DepthSetup& setup = scene.simulation;
    setup.box.dimension = dimension;
    if (is_layer) setup.box = {1, {0, 0, 0}, {10, 0, 0}, {Boundary::periodic}};
    setup.terrain = std::make_shared<const Terrain>(0.0, std::array<double, 2>{-slope, 0});
    setup.settings.gravity = gravity;
    setup.settings.entrainment = growth;
    setup.settings.eta = dimension == 1 ? 1.6 : 1.3;
    setup.settings.largest_smoothing_length = 100;
    Release release;
    release.name = "flow";
    release.shape = SphereShape{{0, 0, 0}, 10};
    if (is_layer) release.shape = BoxShape{{0, 0, 0}, {10, 0, 0}};
    release.spacing = 0.5;
    release.depth = 1;
    release.parabolic = !is_layer;
    release.velocity = {speed, 0, 0};
    scene.releases = {release};
    scene.output.end_time = 10;
    return scene;
}

// Nothing else acts: v = v_0/(1 + E v_0 t), s = ln(1 + E v_0 t)/E. Without error but rounding, 1e-13 over
// some hundred steps.
TEST(DepthEntrainment, AnEvenLayerSlowsDownAsHungrsLawSays) {
    const Communicator comm(MPI_COMM_SELF);
    const DepthScene scene = frictionless(1, true, 0);
    const DepthResult flow = run_depth(comm, scene);
    EXPECT_GT(flow.steps, 100U);
    const double taken = growth * speed * flow.time, way = std::log1p(taken) / growth;
    EXPECT_NEAR(flow.last.volume / flow.first.volume, std::exp(growth * way), 1e-12);
    EXPECT_NEAR(flow.last.momentum[0] / flow.first.momentum[0], 1, 1e-12);
    double start = 0.25;  // of the first column
    for (std::size_t k = 0; k < flow.x.size(); ++k, start += 0.5) {
        EXPECT_NEAR(flow.u[k], speed / (1 + taken), 1e-12 * speed);
        EXPECT_NEAR(std::remainder(flow.x[k] - start - way, 10), 0, 1e-10);
    }
}

// Down a slope, with the acceleration a along it: v^2 = (a/E) (1 - exp(-2 E s)) + v_0^2 exp(-2 E s); so it
// never is faster than sqrt(a/E). The leapfrog's error is of second order in the step.
TEST(DepthEntrainment, ALayerDownASlopeReachesItsGreatestSpeed) {
    const Communicator comm(MPI_COMM_SELF);
    std::vector<double> errors;
    for (const double courant : {0.4, 0.2}) {
        DepthScene scene = frictionless(1, true, 0.1);
        scene.simulation.settings.courant = courant;
        const DepthResult flow = run_depth(comm, scene);
        const double greatest2 = 0.1 * gravity / growth,
                     fading = std::pow(flow.first.volume / flow.last.volume, 2);
        const double exact = std::sqrt(greatest2 * (1 - fading) + speed * speed * fading);
        errors.push_back(std::abs(flow.u.front() / exact - 1));
        fmt::print("layer on a slope, C = {}: {:.6f} m/s, exact {:.6f}, greatest {:.4f} m/s\n", courant,
                   flow.u.front(), exact, std::sqrt(greatest2));
        EXPECT_GT(flow.u.front(), 1.1 * speed);
    }
    EXPECT_LT(errors.back(), 3.3e-6);
    EXPECT_GT(std::log2(errors.front() / errors.back()), 1.8);
}

// A heap that spreads as it slides: every column grows by its own way, and the sum of momenta stays.
TEST(DepthEntrainment, AHeapKeepsItsMomentum) {
    const Communicator comm(MPI_COMM_SELF);
    DepthScene scene = frictionless(2, false, 0);
    scene.output.end_time = 4;
    const DepthResult flow = run_depth(comm, scene);
    const double momentum = flow.first.momentum[0];
    EXPECT_NEAR(flow.last.momentum[0], momentum, 1e-12 * momentum);
    EXPECT_NEAR(flow.last.momentum[1], 0, 1e-12 * momentum);
    const double way = flow.last.centre[0] - flow.first.centre[0];
    fmt::print("heap: volume {:.4f} of exp(E s) of its centre\n",
               flow.last.volume / flow.first.volume / std::exp(growth * way));
    // Columns that go aside or back take up more than the centre's way says.
    EXPECT_GT(flow.last.volume / flow.first.volume, std::exp(growth * way));
    EXPECT_LT(flow.last.volume / flow.first.volume, 1.1 * std::exp(growth * way));
}

}  // namespace
}  // namespace talus::test
