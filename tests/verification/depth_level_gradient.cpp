#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/dam_break.hpp"
#include "tests/support/depth_run.hpp"

/// Columns driven by the gradient of the free surface (depth.gradient = "level").
namespace talus::test {
namespace {

/// Stoker's dam break. Bounds: 1.2 times what was measured when they were set.
TEST(DepthLevelGradient, DamBreakOnAWetBed) {
    const Communicator comm(MPI_COMM_SELF);
    const reference::DamBreak exact(1, 0.25, 9.81);
    const DepthResult flow = run_depth(
        comm,
        depth_scene(
            comm, std::filesystem::path(TALUS_SOURCE_DIR) / "runs/dam_break",
            {R"(release=[{name="reservoir", shape="box", lower=[-20], upper=[0], depth=1, spacing=0.05},)"
             R"({name="below", shape="box", lower=[0], upper=[20], depth=0.25}])",
             "depth.gradient=level"}));
    const auto error = [&](auto&& value) { return flow.mean_error(value, -15, 15); };
    const double depth = error(
                     [&](std::size_t k) { return flow.depth[k] - exact.at(flow.x[k], flow.time).depth; }),
                 speed = error(
                     [&](std::size_t k) { return flow.u[k] - exact.at(flow.x[k], flow.time).velocity; });
    fmt::print("level gradient, wet: {} columns, L1 of depth {:.2e} m, of speed {:.2e} m/s\n", flow.x.size(),
               depth, speed);
    EXPECT_LT(depth, 3e-3);
    EXPECT_LT(speed, 1.2e-2);
    EXPECT_EQ(flow.last.volume, flow.first.volume);
}

/// Even depth on 30 degrees: the surface falls as the bed does, and the middle slides as a block would, by g
/// tan(30 deg), up to rounding.
TEST(DepthLevelGradient, AnEvenLayerOnAPlaneSlidesAsABlock) {
    const Communicator comm(MPI_COMM_SELF);
    const DepthResult flow = run_depth(
        comm, depth_scene(comm, std::filesystem::path(TALUS_SOURCE_DIR) / "runs/dam_break",
                          {R"(release=[{shape="box", lower=[-20], upper=[20], depth=1, spacing=0.2}])",
                           R"(box={boundaries=["open"]})", R"(terrain={dip="30 deg"})",
                           "depth.gradient=level", "run.end_time=0.2"}));
    const double expected = 9.81 * std::tan(std::acos(-1.0) / 6) * flow.time;
    double greatest = 0;
    for (std::size_t k = 0; k < flow.x.size(); ++k)
        if (std::abs(flow.x[k]) < 15) greatest = std::max(greatest, std::abs(flow.u[k] - expected));
    EXPECT_LT(greatest, 1e-10 * expected);
}

}  // namespace
}  // namespace talus::test
