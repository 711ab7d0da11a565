#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "physics/depth/consolidation.hpp"

namespace talus::depth {
namespace {

/// Profiles of particles as a particle set holds them.
struct Profiles {
    std::vector<std::vector<double>> values;
    std::vector<double*> pointers;

    Profiles(std::size_t points, std::size_t particles, double pressure = 0)
        : values(points, std::vector<double>(particles, pressure)) {
        for (std::vector<double>& row : values) pointers.push_back(row.data());
    }
    double at(std::size_t point, std::size_t particle = 0) const { return values[point][particle]; }
};

/// An even load s put on a layer drained at the top: K. Terzaghi (1925).
double terzaghi(double zeta, double time_factor) {
    double sum = 0;
    for (int n = 0; n < 200; ++n) {
        const double wave = (2 * n + 1) * std::numbers::pi / 2;
        sum += (n % 2 == 0 ? 2 : -2) / wave * std::cos(wave * zeta) * std::exp(-wave * wave * time_factor);
    }
    return sum;
}

double terzaghi_error(std::size_t points, int steps, double time_factor, Base base = Base::impermeable) {
    // A drained base halves the path of drainage.
    const double depth = base == Base::impermeable ? 3 : 6, c_v = 2e-4;
    Profiles profiles(points, 1, 1000);
    const std::vector<double> depths{depth};
    const double time_step = time_factor * 9 / c_v / steps;
    for (int step = 0; step < steps; ++step)
        consolidate_profile({c_v, base}, {depths, depths, depths}, time_step, profiles.pointers);
    double error = 0;
    for (std::size_t k = 0; k < points; ++k) {
        const double zeta = static_cast<double>(k) / static_cast<double>(points);
        const double along_path = base == Base::impermeable ? zeta : std::abs(2 * zeta - 1);
        error = std::max(error, std::abs(profiles.at(k) / 1000 - terzaghi(along_path, time_factor)));
    }
    return error;
}

/// Tolerance: the discretisation, second order over the depth and first in time; twice the 0.0006 found once.
TEST(Consolidation, FollowsTerzaghi) {
    for (const double time_factor : {0.1, 0.31, 1.0}) {
        EXPECT_LT(terzaghi_error(20, 4000, time_factor), 1.2e-3) << time_factor;
        EXPECT_LT(terzaghi_error(40, 4000, time_factor, Base::drained), 1.2e-3) << time_factor;
    }
    EXPECT_LT(terzaghi_error(40, 20000, 0.31) / terzaghi_error(20, 20000, 0.31), 0.3);
    EXPECT_LT(terzaghi_error(200, 200, 0.31) / terzaghi_error(200, 100, 0.31), 0.6);
}

TEST(Consolidation, AnyTimeStepIsStable) {
    const std::vector<double> depths{0, 0.5, 20};
    for (const double time_step : {1e-6, 1.0, 1e4, 1e12}) {
        Profiles profiles(15, 3, 1000);
        for (int step = 0; step < 5; ++step)
            consolidate_profile({2e-4}, {depths, depths, depths}, time_step, profiles.pointers);
        for (std::size_t particle = 0; particle < 3; ++particle)
            for (std::size_t k = 0; k < 15; ++k) {
                EXPECT_GE(profiles.at(k, particle), 0);
                EXPECT_LE(profiles.at(k, particle), 1000 * (1 + 1e-12));
                if (k > 0) {
                    EXPECT_LE(profiles.at(k, particle), profiles.at(k - 1, particle) * (1 + 1e-12));
                }
            }
    }
}

/// Undrained, the weight of a column and its pore pressure change together, however the depth moves.
TEST(Consolidation, LiquefiedColumnsStaySoWhileTheirDepthChanges) {
    constexpr std::size_t points = 12, particles = 100;  // more than one block
    const std::vector<double> depths(particles, 2.0);
    std::vector<double> before(particles), after(particles);
    for (std::size_t i = 0; i < particles; ++i) before[i] = 900 + 2700 * static_cast<double>(i);
    Profiles profiles(points, particles), mode(1, particles);
    set_pore_pressure(1, before, profiles.pointers);
    set_pore_pressure(1, before, mode.pointers);
    for (int step = 1; step <= 50; ++step) {
        for (std::size_t i = 0; i < particles; ++i)
            after[i] = before[i] * (1 + 0.2 * std::sin(0.3 * step + static_cast<double>(i)));
        consolidate_profile({0}, {depths, before, after}, 0.1, profiles.pointers);
        consolidate_first_mode({0}, {depths, before, after}, 0.1, mode.values[0]);
        before = after;
    }
    for (std::size_t i = 0; i < particles; ++i) {
        EXPECT_NEAR(mode.at(0, i) / after[i], 1, 1e-12);
        for (std::size_t k = 0; k < points; ++k)
            EXPECT_NEAR(profiles.at(k, i) / (after[i] * (1 - static_cast<double>(k) / points)), 1, 1e-11)
                << i << ' ' << k;
    }
}

/// The cosine is a mode of the profile's equation too. Tolerance: second order over the depth, first in time.
TEST(Consolidation, FirstModeDecaysAsTheProfileDoes) {
    constexpr std::size_t points = 20;
    Profiles profiles(points, 1), mode(1, 1, 5000);
    for (std::size_t k = 0; k < points; ++k)
        profiles.values[k][0] = 5000 * std::cos(std::numbers::pi / 2 * static_cast<double>(k) / points);
    const std::vector<double> depths{2.5};
    const double time = 0.4 * 2.5 * 2.5 / 2e-4;
    for (int step = 0; step < 2000; ++step)
        consolidate_profile({2e-4}, {depths, depths, depths}, time / 2000, profiles.pointers);
    consolidate_first_mode({2e-4}, {depths, depths, depths}, time, mode.values[0]);
    EXPECT_NEAR(mode.at(0), 5000 * std::exp(-std::numbers::pi * std::numbers::pi * 0.1), 1e-9);
    EXPECT_NEAR(profiles.at(0) / mode.at(0), 1, 2e-3);
}

TEST(Consolidation, AThinningColumnHasNoSuction) {
    const std::vector<double> depth{1}, heavy{9e4}, light{9e3};
    Profiles profiles(8, 1), mode(1, 1);
    set_pore_pressure(0.3, heavy, profiles.pointers);
    set_pore_pressure(0.3, heavy, mode.pointers);
    EXPECT_DOUBLE_EQ(profiles.at(2), 0.3 * 9e4 * 0.75);
    consolidate_profile({2e-4}, {depth, heavy, light}, 0.1, profiles.pointers);
    consolidate_first_mode({2e-4}, {depth, heavy, light}, 0.1, mode.values[0]);
    for (std::size_t k = 0; k < 8; ++k) EXPECT_EQ(profiles.at(k), 0);
    EXPECT_EQ(mode.at(0), 0);
}

TEST(Consolidation, ADrainedBaseBearsNoExcess) {
    const std::vector<double> depths{2};
    Profiles profiles(10, 1, 1000);
    consolidate_profile({2e-4, Base::drained}, {depths, depths, depths}, 10, profiles.pointers);
    EXPECT_EQ(profiles.at(0), 0);
    EXPECT_GT(profiles.at(5), 900);
}

}  // namespace
}  // namespace talus::depth
