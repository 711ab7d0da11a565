#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/gravity_cloud.hpp"

/// Self-gravity of clouds: the same bits whoever owns what, and the distance from the direct sum.
namespace talus::test {
namespace {

constexpr std::size_t count = 1500;

gravity::Settings direct() {
    gravity::Settings settings;
    settings.direct = true;
    return settings;
}

bool same_bits(const GravityCloud::Forces& a, const GravityCloud::Forces& b) {
    return a.acceleration == b.acceleration && a.potential == b.potential;
}

struct Variant {
    gravity::Opening opening = gravity::Opening::geometric;
    gravity::Precision precision = gravity::Precision::single_precision;
    int order = 3;
    bool direct = false;
};

gravity::Settings settings_of(const Variant& variant) {
    gravity::Settings settings;
    settings.opening = variant.opening;
    settings.precision = variant.precision;
    settings.order = variant.order;
    settings.direct = variant.direct;
    settings.leaf_size = 4;  // a deeper tree
    return settings;
}

TEST(GravitySameBits, WhoeverOwnsWhat) {
    const Communicator world(MPI_COMM_WORLD), alone(MPI_COMM_SELF);
    using enum PartitionMethod;
    for (const std::string kind : {"pair", "clumps", "ejecta"})
        for (const Variant& variant :
             {Variant{}, Variant{gravity::Opening::relative, gravity::Precision::double_precision, 2},
              Variant{.direct = true}}) {
            const gravity::Settings settings = settings_of(variant);
            GravityCloud whole(alone, kind, count);
            whole.evaluate(settings);
            const gravity::Counts counts = whole.evaluate(settings);  // relative to the first
            const GravityCloud::Forces expected = whole.forces();
            for (const PartitionMethod method : {metis, bisection, slabs, scrambled}) {
                GravityCloud shared(world, kind, count, method);
                shared.evaluate(settings);
                const gravity::Counts mine = shared.evaluate(settings);
                EXPECT_TRUE(same_bits(shared.forces(), expected))
                    << kind << ", method " << static_cast<int>(method);
                EXPECT_EQ(world.all_sum(mine.interactions()), counts.interactions());
                EXPECT_EQ(world.all_sum(mine.nodes), counts.nodes);
            }
        }
}

TEST(GravityTree, ErrorFallsWithTheAngleAndTheOrder) {
    const Communicator comm(MPI_COMM_SELF);
    // Bounds at theta = 0.7, of the error over the mean acceleration: twice what was found.
    for (const std::string kind : {"sphere", "pair", "clumps"}) {
        GravityCloud cloud(comm, kind, count);
        cloud.evaluate(direct());
        const GravityCloud::Forces exact = cloud.forces();
        double of_lower_order = 1;
        for (const int order : {1, 2, 3}) {
            double of_larger_angle = 1;
            for (const double theta : {0.7, 0.5, 0.3, 0.2}) {
                gravity::Settings settings = settings_of({.order = order});
                settings.theta = theta;
                cloud.evaluate(settings);
                const GravityError error = error_of(cloud.forces(), exact);
                EXPECT_LT(error.rms, 0.9 * of_larger_angle) << kind << order << theta;
                EXPECT_LT(error.rms_potential, error.rms) << kind << order << theta;
                of_larger_angle = error.rms;
                if (theta == 0.7) {
                    EXPECT_LT(error.rms, order == 1 ? 3e-2 : order == 2 ? 5e-3 : 3e-3) << kind << order;
                    EXPECT_LT(error.rms, 0.9 * of_lower_order) << kind << order;
                    of_lower_order = error.rms;
                }
            }
            gravity::Settings settings =
                settings_of({gravity::Opening::relative, gravity::Precision::double_precision, order});
            double of_coarser = 1;
            for (const double accuracy : {1e-2, 1e-3, 1e-4}) {
                settings.accuracy = accuracy;
                cloud.evaluate(settings);
                const double error = error_of(cloud.forces(), exact).rms;
                EXPECT_LT(error, 0.9 * of_coarser) << kind << order << accuracy;
                of_coarser = error;
            }
        }
    }
}

TEST(GravityTree, SmallestAngleGivesTheDirectSum) {
    const Communicator comm(MPI_COMM_SELF);
    for (const std::string kind : {"sphere", "ejecta"}) {
        GravityCloud cloud(comm, kind, 400);
        cloud.evaluate(direct());
        const GravityCloud::Forces exact = cloud.forces();
        gravity::Settings settings = settings_of({.precision = gravity::Precision::double_precision});
        settings.theta = 1e-6;
        const gravity::Counts counts = cloud.evaluate(settings);
        EXPECT_EQ(counts.nodes, 0u);
        EXPECT_EQ(counts.interactions(), 400u * 400u);
        EXPECT_LT(error_of(cloud.forces(), exact).greatest, 1e-13) << "rounding of 400 terms";
        settings.precision = gravity::Precision::single_precision;
        cloud.evaluate(settings);
        EXPECT_LT(error_of(cloud.forces(), exact).greatest, 1e-5) << "rounding of 400 terms";
    }
}

TEST(GravityTree, FarParticlesCostNoMoreThanNearOnes) {
    const Communicator comm(MPI_COMM_SELF);
    gravity::Settings settings;
    GravityCloud near(comm, "sphere", 5000), far(comm, "ejecta", 5000);
    const gravity::Counts without = near.evaluate(settings), with = far.evaluate(settings);
    // 2 % of the particles fly off; those at each distance add some nodes to everyone's list.
    EXPECT_LT(with.interactions(), 1.15 * static_cast<double>(without.interactions()));
}

TEST(GravityTree, WorksBeyondTheOutermostCells) {
    const Communicator comm(MPI_COMM_WORLD);
    GravityCloud cloud(comm, "sphere", 400);
    const auto fly = [&](std::uint64_t id, const std::array<double, 3>& to) {
        for (std::size_t i = 0; i < cloud.particles.size(); ++i)
            if (cloud.particles.data(field::id)[i] == id)
                for (int a = 0; a < 3; ++a)
                    cloud.particles.data(field::position, a)[i] = to[static_cast<std::size_t>(a)];
    };
    constexpr double far = 1e9;  // the outermost cells are at some 3e5
    fly(7, {far, 0, 0});
    fly(8, {far, 0.5, 0});
    fly(9, {-far, far, far});
    cloud.decomposition.arrange(cloud.particles, *cloud.grid);
    cloud.evaluate(direct());
    const GravityCloud::Forces exact = cloud.forces();
    gravity::Settings settings = settings_of({.precision = gravity::Precision::double_precision});
    settings.leaf_size = 1;  // 7 and 8 share one all the same
    cloud.evaluate(settings);
    const GravityCloud::Forces found = cloud.forces();
    EXPECT_LT(error_of(found, exact).rms, 3e-3);
    const double pull = exact.mass[8] / 0.25;
    EXPECT_NEAR(found.acceleration[7][1], pull, 1e-9 * pull) << "the neighbour, not the distant rest";
    settings.precision = gravity::Precision::single_precision;
    cloud.evaluate(settings);
    EXPECT_NEAR(cloud.forces().acceleration[7][1], pull, 1e-5 * pull) << "as near as any pair";
}

}  // namespace
}  // namespace talus::test
