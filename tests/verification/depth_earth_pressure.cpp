#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "domain/depth_fields.hpp"
#include "tests/support/dam_break.hpp"
#include "tests/support/depth_run.hpp"
#include "tests/support/scene_run.hpp"

/// Earth pressure of Savage and Hutter on a smooth bed: K_act = (1 - sin phi)/(1 + sin phi), K_pas = 1/K_act.
namespace talus::test {
namespace {

constexpr double gravity = 9.81;
constexpr double active = (1 - 0.5) / (1 + 0.5), passive = 1 / active;  // sin(30 deg) = 0.5

// All of it spreads: Ritter's solution with gravity K_act g, its waves with sqrt(K_act g h). Bounds: those of
// the hydrostatic dam break (depth_dam_breaks.cpp); velocities are smaller by sqrt(K_act).
TEST(DepthEarthPressure, AnActiveDamBreakIsRittersWithLessGravity) {
    const Communicator comm(MPI_COMM_SELF);
    const reference::DamBreak exact(1, 0, active * gravity);
    std::vector<double> depths, speeds;
    for (const int particles : {400, 1600}) {
        const DepthResult flow =
            run_depth(comm, depth_scene(comm, std::filesystem::path(TALUS_SOURCE_DIR) / "runs/dam_break",
                                        {"depth.internal_friction_angle=\"30 deg\"", "run.end_time=3",
                                         fmt::format("release[0].particles={}", particles)}));
        const auto error = [&](auto&& value) { return flow.mean_error(value, -15, 15); };
        depths.push_back(
            error([&](std::size_t k) { return flow.depth[k] - exact.at(flow.x[k], flow.time).depth; }));
        speeds.push_back(
            error([&](std::size_t k) { return flow.u[k] - exact.at(flow.x[k], flow.time).velocity; }));
        fmt::print("active dam break: {} columns, L1 of depth {:.2e} m, of velocity {:.2e} m/s\n", particles,
                   depths.back(), speeds.back());
    }
    EXPECT_LT(depths.back(), 1.07e-3);
    EXPECT_LT(speeds.back(), 3.8e-3 * std::sqrt(active));
    EXPECT_GT(order_of(depths.front(), depths.back()) / 2, 0.85);
    EXPECT_GT(order_of(speeds.front(), speeds.back()) / 2, 0.85);
}

/// A parabolic heap of half length L, thrown together: it stays a parabola, and its coefficient of earth
/// pressure is the same all over, L'' = 2 K g H_0 L_0/L^2, K' = - stiffness L'/L within its limits.
struct Heap {
    double length, speed, coefficient = active;

    /// One step of Runge and Kutta's second order (midpoint).
    void move(double dt, const depth::EarthPressure& law, double strength) {
        const auto pushed = [&](double time, const Heap& by) {
            Heap next = *this;
            next.length += by.speed * time;
            next.speed += strength * by.coefficient / (by.length * by.length) * time;
            next.coefficient = std::clamp(coefficient - law.stiffness() * by.speed / by.length * time,
                                          law.active, law.passive);
            return next;
        };
        *this = pushed(dt, pushed(dt / 2, *this));
    }
};

/// Root of the mean square of the distance from the middle, which the length of a parabola is 5^(1/2) times.
double spread(const ParticleSet& columns) {
    double sum = 0, volume = 0;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const double x = columns.data(field::position)[i], own = columns.data(field::volume)[i];
        sum += own * x * x;
        volume += own;
    }
    return std::sqrt(sum / volume);
}

// Into the passive limit, turned round by it, and out again. The error is 8e-4 and 5e-3 of the first length;
// it does not fall with the spacing, since columns that are compressed far do not stay in even distances.
TEST(DepthEarthPressure, AHeapThrownTogetherReachesThePassiveLimit) {
    const Communicator comm(MPI_COMM_SELF);
    constexpr double length = 10, depth = 1, closing = 4;
    const depth::EarthPressure law{.active = active, .passive = passive};
    for (const int particles : {100, 400}) {
        DepthScene scene = depth_scene(
            comm, std::filesystem::path(TALUS_SOURCE_DIR) / "runs/dam_break",
            {R"(release=[{shape="sphere", centre=[0], radius=10, depth=1, profile="parabolic"}])",
             fmt::format("release[0].particles={}", particles), "depth.internal_friction_angle=\"30 deg\""});
        ParticleSet columns = make_columns(comm, scene);
        for (std::size_t i = 0; i < columns.size(); ++i)
            columns.data(field::velocity)[i] = -closing * columns.data(field::position)[i] / length;
        DepthSimulation flow(comm, scene.simulation, std::move(columns));
        flow.start();
        Heap exact{length, -closing};
        double time = 0, worst = 0, shortest = length, most = 0;
        const double first = spread(flow.particles());
        while (time < 4) {
            flow.step();
            for (constexpr double dt = 1e-4; time + dt < flow.time(); time += dt)
                exact.move(dt, law, 2 * gravity * depth * length);
            const double found = spread(flow.particles()) / first;
            worst = std::max(worst, std::abs(found - exact.length / length));
            shortest = std::min(shortest, found);
            most = std::max(most, exact.coefficient);
        }
        fmt::print(
            "heap thrown together: {} columns, shortest {:.4f}, error of the length {:.2e}, then {:.4f}, "
            "exact {:.4f}\n",
            particles, shortest, worst, spread(flow.particles()) / first, exact.length / length);
        EXPECT_EQ(most, passive);
        EXPECT_LT(shortest, 0.9);
        EXPECT_LT(worst, 0.01);
    }
}

// A layer that rests does so whatever its rounding errors say: a coefficient that jumped with the sign of div
// v made it boil.
TEST(DepthEarthPressure, ALayerAtRestStaysAtRest) {
    const Communicator comm(MPI_COMM_SELF);
    const DepthResult flow = run_depth(
        comm, depth_scene(comm, std::filesystem::path(TALUS_SOURCE_DIR) / "runs/dam_break",
                          {R"(release=[{shape="box", lower=[-20], upper=[20], depth=1, particles=200}])",
                           "depth.internal_friction_angle=\"30 deg\"", "run.end_time=20"}));
    EXPECT_LT(flow.greatest_speed, 1e-12);
}

}  // namespace
}  // namespace talus::test
