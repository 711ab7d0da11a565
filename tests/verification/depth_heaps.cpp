#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/depth_run.hpp"
#include "tests/support/scene_run.hpp"
#include "tests/support/similarity_heap.hpp"

/// Heaps on rough planes: those that slide, against the similarity solution, and those that stay.
namespace talus::test {
namespace {

constexpr double degree = std::numbers::pi / 180;

DepthScene heap(const Communicator& comm, const std::vector<std::string>& overrides) {
    return depth_scene(comm, std::filesystem::path(TALUS_SOURCE_DIR) / "runs" / "similarity_heap", overrides);
}

struct HeapErrors {
    double centre, front, width, depth, velocity;  ///< all over those of the solution
};

HeapErrors slide(const Communicator& comm, int dimension, int particles) {
    std::vector<std::string> overrides = {fmt::format("release[0].particles={}", particles)};
    if (dimension == 1)
        overrides.insert(overrides.end(), {"dimension=1", "release[0].semi_axes=[65.53216354311934]"});
    const DepthResult flow = run_depth(comm, heap(comm, overrides));
    const reference::SimilarityHeap exact({35 * degree, 25 * degree, 9.81}, {4, 80, dimension}, flow.time);
    const double cosine = std::cos(35 * degree);
    const auto s = [&](std::size_t k) { return flow.x[k] / cosine; };
    const HeapErrors errors{flow.last.centre[0] / cosine / exact.centre() - 1,
                            flow.last.greatest_place[0] / cosine / exact.front() - 1,
                            dimension == 2 ? flow.last.greatest_place[1] / exact.width() - 1 : 0,
                            flow.mean_error(
                                [&](std::size_t k) {
                                    return flow.depth[k] / exact.depth(exact.centre(), 0) -
                                           exact.depth(s(k), flow.y[k]) / exact.depth(exact.centre(), 0);
                                },
                                -1e9, 1e9),
                            flow.mean_error(
                                [&](std::size_t k) {
                                    return flow.u[k] / cosine / exact.speed() -
                                           exact.velocity(s(k)) / exact.speed();
                                },
                                -1e9, 1e9)};
    fmt::print("| {} | {} | {:+.2e} | {:+.2e} | {:+.2e} | {:.2e} | {:.2e} |\n", dimension, flow.x.size(),
               errors.centre, errors.front, errors.width, errors.depth, errors.velocity);
    return errors;
}

// In one dimension the solution is exact, and friction the same everywhere: the centre falls as a block does,
// which the leapfrog does without error.
TEST(DepthHeap, SlidesAsTheSimilaritySolution) {
    const Communicator world(MPI_COMM_WORLD), alone(MPI_COMM_SELF);
    if (world.is_root()) {
        std::vector<HeapErrors> errors;
        for (const int n : {50, 100, 200}) errors.push_back(slide(alone, 1, n));
        EXPECT_LT(std::abs(errors.back().centre), 1e-13);
        EXPECT_LT(std::abs(errors.back().front), 8e-3);
        EXPECT_LT(errors.back().depth, 3.2e-4);
        EXPECT_LT(errors.back().velocity, 7.5e-5);
        EXPECT_GT(order_of(errors.front().depth, errors.back().depth) / 2, 1.5);
    }
    // In two, friction is along the velocity: the solution takes all of it to act down the slope, which holds
    // the centre back by 0.3 %. The first and the last of the edges' particles lie within the edge by half a
    // spacing.
    if (world.rank() == world.size() - 1) {
        const HeapErrors coarse = slide(alone, 2, 500), fine = slide(alone, 2, 2000);
        EXPECT_LT(std::abs(fine.centre), 3.4e-3);
        EXPECT_LT(std::abs(fine.front), 1.5e-2);
        EXPECT_LT(std::abs(fine.width), 3e-2);
        EXPECT_LT(fine.depth, 7.5e-3);
        EXPECT_LT(fine.velocity, 2.2e-3);
        EXPECT_LT(fine.depth, coarse.depth);
    }
}

// A heap whose surface and bed are both gentler than the friction: nothing moves, to the bit.
TEST(DepthHeap, StaysBelowTheAngleOfFriction) {
    const Communicator comm(MPI_COMM_SELF);
    const DepthResult still =
        run_depth(comm, heap(comm, {"terrain.dip=0.3", "release[0].particles=500", "run.end_time=20"}));
    EXPECT_EQ(still.greatest_speed, 0);
    EXPECT_EQ(still.last.stopped, 1);
    EXPECT_EQ(still.last.centre, still.first.centre);
    EXPECT_GT(still.steps, 20U);
    const DepthResult moving =
        run_depth(comm, heap(comm, {"terrain.dip=0.3", "friction.angle=0.29", "release[0].particles=500"}));
    EXPECT_GT(moving.greatest_speed, 0.1);
}

}  // namespace
}  // namespace talus::test
