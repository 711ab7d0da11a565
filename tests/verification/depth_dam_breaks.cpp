#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
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

/// These flows are too small to share: each case runs on one rank, by turns.
bool is_mine(int which) {
    const Communicator all(MPI_COMM_WORLD);
    return which % all.size() == all.rank();
}

void print_row(const char* name, const DepthResult& flow, const Errors& errors) {
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

struct Row {
    const char* name;
    double downstream;  ///< depth [m]
    Errors finest, least_order;
};

void expect_dam_breaks(const Row& row) {
    const Communicator comm(MPI_COMM_SELF);
    const reference::DamBreak exact(1, row.downstream, 9.81);
    std::vector<Errors> errors;
    for (const int n : {200, 400, 800}) {
        std::string releases = fmt::format(
            R"({{name="reservoir", shape="box", lower=[-20], upper=[0], depth=1, spacing={}}})", 20.0 / n);
        if (row.downstream > 0)
            releases += fmt::format(R"(, {{name="below", shape="box", lower=[0], upper=[20], depth={}}})",
                                    row.downstream);
        const DepthResult flow =
            run_depth(comm, depth_scene(comm, scene("dam_break"), {fmt::format("release=[{}]", releases)}));
        EXPECT_EQ(flow.last.volume, flow.first.volume);
        EXPECT_GT(*std::min_element(flow.depth.begin(), flow.depth.end()), 0);
        errors.push_back(errors_of(flow, exact, -15, 15));
        print_row(row.name, flow, errors.back());
        if (row.downstream == 0 || n < 800) continue;
        double behind = 0;  // farthest place that is deeper than the mean of the bore's two sides
        for (std::size_t k = 0; k < flow.x.size(); ++k)
            if (flow.depth[k] > 0.5 * (exact.middle().depth + row.downstream))
                behind = std::max(behind, flow.x[k]);
        const double bore = exact.bore_speed() * flow.time;
        fmt::print("bore at {:.4f} m, exact {:.4f} m\n", behind, bore);
        EXPECT_NEAR(behind, bore, 0.02 * bore);
        const auto on_plateau = [&](auto&& value) { return flow.mean_error(value, 0.25 * bore, 0.9 * bore); };
        EXPECT_LT(on_plateau([&](std::size_t k) { return flow.depth[k] / exact.middle().depth - 1; }), 0.01);
        EXPECT_LT(on_plateau([&](std::size_t k) { return flow.u[k] / exact.middle().velocity - 1; }), 0.01);
    }
    expect_convergence(errors, row.finest, row.least_order);
}

TEST(DepthDamBreak, OnADryBedConverges) {
    if (is_mine(0)) expect_dam_breaks({"dry", 0, {1.07e-3, 3.8e-3}, {0.85, 0.85}});
}

TEST(DepthDamBreak, OnAWetBedConverges) {
    if (is_mine(1)) expect_dam_breaks({"wet", 0.25, {1.1e-3, 3.6e-3}, {0.85, 0.85}});
}

TEST(DepthDamBreak, OnARoughInclineConverges) {
    if (!is_mine(0)) return;
    const Communicator comm(MPI_COMM_SELF);
    const double angle = std::numbers::pi / 6, friction = std::numbers::pi / 9;
    const double normal = 9.81 * std::cos(angle);
    const reference::InclinedDamBreak exact{1, normal, normal * (std::tan(angle) - std::tan(friction))};
    std::vector<Errors> errors;
    for (const int n : {400, 800, 1600}) {
        const DepthResult flow = run_depth(comm, depth_scene(comm, scene("inclined_dam_break"),
                                                             {fmt::format("release[0].particles={}", n)}));
        const auto at = [&](std::size_t k) { return exact.at(flow.x[k] / std::cos(angle), flow.time); };
        errors.push_back(
            {flow.mean_error([&](std::size_t k) { return flow.depth[k] - at(k).depth; }, -20, 40),
             flow.mean_error([&](std::size_t k) { return flow.u[k] / std::cos(angle) - at(k).velocity; }, -20,
                             40)});
        print_row("incline", flow, errors.back());
        fmt::print(
            "front at {:.3f} m, exact {:.3f} m\n", flow.last.greatest_place[0] / std::cos(angle),
            2 * std::sqrt(exact.gravity) * flow.time + 0.5 * exact.acceleration * flow.time * flow.time);
    }
    expect_convergence(errors, {5.7e-4, 1.9e-3}, {0.85, 0.85});
}

// Pair forces are opposite to rounding: a square of water in the open that falls apart keeps its momentum.
TEST(DepthDamBreak, KeepsItsMomentum) {
    if (!is_mine(1)) return;
    const Communicator comm(MPI_COMM_SELF);
    const DepthResult flow = run_depth(
        comm, depth_scene(comm, scene("dam_break"),
                          {"dimension=2", "box.boundaries=[\"open\",\"open\"]", "box.lower=[-20,-20]",
                           "box.upper=[20,20]", "release[0].lower=[-2,-3]", "release[0].upper=[3,1]",
                           "release[0].particles=1600", "run.end_time=1"}));
    double size = 0;
    for (std::size_t k = 0; k < flow.x.size(); ++k)
        size += 1000 * flow.volume[k] * std::hypot(flow.u[k], flow.v[k]);
    EXPECT_GT(size, 1e4);
    EXPECT_LT(std::hypot(flow.last.momentum[0], flow.last.momentum[1]), 1e-12 * size);
    EXPECT_EQ(flow.last.volume, flow.first.volume);
}

}  // namespace
}  // namespace talus::test
