#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "physics/dem/laws/damping.hpp"
#include "physics/dem/laws/materials.hpp"
#include "physics/dem/laws/time_step.hpp"

namespace talus::dem {
namespace {

/// gamma of C. Thornton, S. J. Cummins, P. W. Cleary, Powder Technol. 233 (2013) 30, where gamma_n = 2 gamma
/// sqrt(m* K_n) with the tangent stiffness K_n = 3/2 k_n.
double thornton_fit(double e) {
    constexpr std::array h{-6.918798, -16.41105, 146.8049,  -796.4559, 2928.711,
                           -7206.864, 11494.29,  -11342.18, 6276.757,  -1489.915};
    double alpha = 0;
    for (std::size_t k = h.size(); k-- > 0;) alpha = e * (h[k] + alpha);
    return std::sqrt(1 / (1 - (1 + e) * (1 + e) * std::exp(alpha)) - 1);
}

TEST(GrainDamping, CutHertzAgreesWithThePublishedFit) {
    // The fit gives the restitution within 3e-4 up to e = 0.8 (and 0.979 for 0.99), as integrating shows.
    for (const double e : {0.1, 0.2, 0.3, 0.5, 0.6, 0.7, 0.8})
        EXPECT_NEAR(hertz_damping(e, EndOfContact::cut_at_zero) / (2 * std::sqrt(1.5) * thornton_fit(e)), 1,
                    2.5e-3)
            << e;
}

TEST(GrainDamping, ConventionsDifferWhereDampingIsStrong) {
    EXPECT_NEAR(hertz_damping(0.6, EndOfContact::may_attract), 0.35887, 5e-6);  // sqrt(5) B(0.6)
    EXPECT_GT(hertz_damping(0.6, EndOfContact::cut_at_zero), 0.39);
    for (const double e : {0.02, 0.3, 0.6, 0.9, 0.999}) {
        EXPECT_GT(hertz_damping(e, EndOfContact::cut_at_zero), hertz_damping(e, EndOfContact::may_attract));
        EXPECT_GT(linear_damping(e, EndOfContact::cut_at_zero), linear_damping(e, EndOfContact::may_attract));
    }
}

TEST(GrainDamping, EndsOfTheScale) {
    for (const auto end : {EndOfContact::may_attract, EndOfContact::cut_at_zero}) {
        EXPECT_EQ(hertz_damping(1, end), 0);
        EXPECT_EQ(linear_damping(1, end), 0);
        for (const double e : {-0.1, 1.01, std::nan("")}) {
            EXPECT_THROW(hertz_damping(e, end), std::invalid_argument);
            EXPECT_THROW(linear_damping(e, end), std::invalid_argument);
        }
    }
    EXPECT_EQ(linear_damping(0, EndOfContact::may_attract), 2);
    EXPECT_THROW(hertz_damping(0, EndOfContact::cut_at_zero), std::invalid_argument);
}

TEST(GrainMaterials, PairsAreMixedOrStated) {
    const GrainMaterial rubber{.name = "rubber",
                               .youngs_modulus = 1e6,
                               .poisson_ratio = 0.5,
                               .restitution = 0.5,
                               .friction = 0.9,
                               .rolling_friction = 0.04};
    const GrainMaterial steel{.name = "steel",
                              .youngs_modulus = 2e11,
                              .poisson_ratio = 0.3,
                              .restitution = 0.98,
                              .friction = 0.4,
                              .rolling_friction = 0};
    MaterialPairs pairs({rubber, steel});
    const PairProperties mixed = pairs(1, 0);
    EXPECT_NEAR(mixed.effective_modulus, 1 / (0.75 / 1e6 + 0.91 / 2e11), 1e-6);
    EXPECT_NEAR(mixed.effective_shear_modulus, 1 / (1.5 * 3 / 1e6 + 1.7 * 2.6 / 2e11), 1e-6);
    EXPECT_DOUBLE_EQ(mixed.friction, 0.6);
    EXPECT_DOUBLE_EQ(mixed.restitution, 0.7);
    EXPECT_EQ(mixed.rolling_friction, 0);
    pairs.state(1, 0,
                {.restitution = 0.3,
                 .friction = {},
                 .rolling_friction = {},
                 .rolling_damping = {},
                 .twisting_friction = {},
                 .work_of_adhesion = {}});
    EXPECT_EQ(pairs(0, 1).restitution, 0.3);
    EXPECT_EQ(pairs(1, 0).restitution, 0.3);
    EXPECT_DOUBLE_EQ(pairs(1, 0).friction, 0.6);
    EXPECT_DOUBLE_EQ(pairs(0, 0).restitution, 0.5);
}

TEST(GrainMaterials, TableIsSymmetricAndGathersIntoLanes) {
    using Law = HertzMindlin<double>;
    const PairTable<Law> table(3, [](std::size_t a, std::size_t b) {
        return Law{.effective_modulus = 10.0 * static_cast<double>(a) + static_cast<double>(b),
                   .effective_shear_modulus = 1,
                   .normal_damping = 2,
                   .tangential_damping = 3,
                   .least_force = 4};
    });
    EXPECT_EQ(table(2, 1).effective_modulus, 12);
    EXPECT_EQ(table(1, 2).effective_modulus, 12);
    std::array<std::size_t, lane_count> index{};
    for (std::size_t lane = 0; lane < lane_count; ++lane) index[lane] = table.index(lane % 3, 2);
    const auto gathered = gather<HertzMindlin<Lanes>>(table, index);
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
        EXPECT_EQ(gathered.effective_modulus[lane], table[index[lane]].effective_modulus);
        EXPECT_EQ(gathered.least_force[lane], 4);
        EXPECT_EQ((in_all_lanes<HertzMindlin<Lanes>>(table(0, 2)).effective_modulus[lane]), 2);
    }
}

TEST(GrainTimeStep, RayleighTimesOfTheBenchmarkOfDosta2024) {
    // 4 mm grains, E = 1 and 0.5 GPa, nu = 0.2, 2500 and 2000 kg/m3: 1.69e-5 s and 2.14e-5 s.
    const GrainMaterial m1{.name = "M1", .youngs_modulus = 1e9, .poisson_ratio = 0.2},
        m2{.name = "M2", .youngs_modulus = 0.5e9, .poisson_ratio = 0.2};
    EXPECT_NEAR(rayleigh_time(2e-3, 2500, shear_modulus(m1), 0.2), 1.69e-5, 0.005e-5);
    EXPECT_NEAR(rayleigh_time(2e-3, 2000, shear_modulus(m2), 0.2), 2.14e-5, 0.005e-5);
}

/// Frequencies squared [k_n/m] of the closest packing for one wave vector: every grain moves and turns,
/// springs k_n and k_t in every contact. Greatest of them by the power method.
double greatest_of_wave(const std::array<double, 3>& wave, double ratio) {
    using Six = std::array<std::array<double, 2>, 6>;  // displacement, radius times angle; real, imaginary
    std::vector<Vector3<double>> bonds;
    for (const double p : {-1.0, 1.0})
        for (const double q : {-1.0, 1.0}) {
            bonds.push_back(std::sqrt(0.5) * Vector3<double>{p, q, 0});
            bonds.push_back(std::sqrt(0.5) * Vector3<double>{p, 0, q});
            bonds.push_back(std::sqrt(0.5) * Vector3<double>{0, p, q});
        }
    const auto apply = [&](const Six& x) {
        Six result{};
        for (const Vector3<double>& e : bonds) {
            const double phase = wave[0] * e.x + wave[1] * e.y + wave[2] * e.z;
            for (std::size_t part = 0; part < 2; ++part) {
                const auto neighbour = [&](std::size_t c) {
                    return part == 0 ? std::cos(phase) * x[c][0] - std::sin(phase) * x[c][1]
                                     : std::cos(phase) * x[c][1] + std::sin(phase) * x[c][0];
                };
                const Vector3<double> jump{x[0][part] - neighbour(0), x[1][part] - neighbour(1),
                                           x[2][part] - neighbour(2)};
                const Vector3<double> turn{x[3][part] + neighbour(3), x[4][part] + neighbour(4),
                                           x[5][part] + neighbour(5)};
                const Vector3<double> stretch = jump + cross(turn, e);
                const Vector3<double> force = -(dot(stretch, e) * e) - ratio * tangential_part(stretch, e);
                const Vector3<double> torque = cross(e, force);
                const std::array<double, 6> answer{force.x,        force.y,        force.z,
                                                   2.5 * torque.x, 2.5 * torque.y, 2.5 * torque.z};
                for (std::size_t c = 0; c < 6; ++c) result[c][part] -= answer[c];
            }
        }
        return result;
    };
    Six x{{{1, 0.3}, {0.7, -0.2}, {-0.4, 0.5}, {0.9, 0.1}, {-0.6, 0.8}, {0.35, -0.7}}};
    double greatest = 0;
    for (int iteration = 0; iteration < 300; ++iteration) {
        const Six y = apply(x);
        double size = 0;
        for (const auto& c : y) size += c[0] * c[0] + c[1] * c[1];
        greatest = std::sqrt(size);
        if (greatest == 0) return 0;
        for (std::size_t c = 0; c < 6; ++c)
            for (std::size_t part = 0; part < 2; ++part) x[c][part] = y[c][part] / greatest;
    }
    return greatest;
}

/// Tangential springs count twice at the wall: tests/stability/grain_lattice.cpp.
TEST(GrainTimeStep, PackedLatticeLimitIsTheFastestWaveOfTheClosestPacking) {
    for (const double ratio : {0.0, 0.1, 2.0 / 7, 0.5, 1.0}) {
        double greatest = 0;
        constexpr int count = 4;
        const double unit = std::sqrt(2.0) * 2 * std::numbers::pi / count;
        for (int a = 0; a < count; ++a)
            for (int b = 0; b < count; ++b)
                for (int c = 0; c < count; ++c)
                    greatest = std::max(greatest, greatest_of_wave({a * unit, b * unit, c * unit}, ratio));
        EXPECT_NEAR(packed_lattice_limit(3, 12, 0.5 * 12 * ratio, 0), 2 / std::sqrt(greatest * 12 / 3), 1e-6)
            << ratio;
    }
    EXPECT_NEAR(packed_lattice_limit(1, 1, 0, 0), 0.7071, 1e-4);
    EXPECT_NEAR(packed_lattice_limit(1, 1, 0.5, 0), 0.316, 5e-4);
    // 4 = 80 dt^2 + 4 c dt, c = 40 gamma_t/m, gamma_t = 0.2 sqrt(2 k_n m)
    EXPECT_NEAR(packed_lattice_limit(1, 1, 1, 0.2), 2 / (8 * std::sqrt(2) + std::sqrt(208)), 1e-12);
}

}  // namespace
}  // namespace talus::dem
