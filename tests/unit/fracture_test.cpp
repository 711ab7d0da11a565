#include "physics/solid/fracture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "physics/solid/material.hpp"
#include "tests/support/grady_kipp_reference.hpp"
#include "tests/support/solid_materials.hpp"

namespace talus {
namespace {

const Fracture basalt_flaws{.weibull_k = 4e35, .weibull_m = 9};

Material basalt() {
    return {.name = "basalt",
            .eos = test::basalt(),
            .shear_modulus = 22.7e9,
            .bulk_modulus = 26.7e9,
            .reference_density = 2700,
            .fracture = basalt_flaws};
}

struct Moments {
    double sum = 0, squares = 0;
    int count = 0;
    void add(double x) {
        sum += x;
        squares += x * x;
        ++count;
    }
    double mean() const { return sum / count; }
    double error() const {  // of the mean
        return std::sqrt(std::max(squares / count - mean() * mean(), 0.0) / count);
    }
};

TEST(Material, ConstantsOfBasalt) {
    const Material rock = basalt();
    EXPECT_NEAR(rock.young_modulus(), 53.06e9, 0.01e9);
    EXPECT_NEAR(rock.longitudinal_speed(), 4593, 1);
    EXPECT_NEAR(rock.crack_growth().crack_speed, 0.4 * 4593, 0.5);
    EXPECT_EQ(bulk_modulus(rock.eos), 26.7e9);
    EXPECT_NEAR(bulk_modulus(LinearEquationOfState{1000, 10}), 1e5, 1e-6);
}

TEST(Flaws, OpenBetweenTheWeakestAndTheStrongest) {
    const Flaws flaws{.threshold = 1e-3f, .exponent = 9, .count = 512};
    const double weakest = static_cast<double>(flaws.threshold);
    EXPECT_EQ(flaws.open(0.999 * weakest), 0);
    EXPECT_EQ(flaws.open(weakest), 1);
    EXPECT_NEAR(flaws.open(1.5 * weakest), std::pow(1.5, 9), 1e-9);
    EXPECT_EQ(flaws.open(2.1 * weakest), 512);
    EXPECT_EQ((Flaws{}.open(1)), 0) << "no flaws";
    const Flaws steep{.threshold = 1e-3f, .exponent = 1e30f, .count = 2};
    EXPECT_EQ(steep.open(weakest), 1);
    EXPECT_EQ(steep.open(1.0001 * weakest), 2);
}

TEST(FlawSampler, DropsAsManyAsACouponCollector) {
    Moments dropped;
    constexpr std::uint64_t N = 100000;
    for (std::uint64_t seed = 0; seed < 2000; ++seed)
        dropped.add(FlawSampler(basalt_flaws, 1, N, seed, 0).dropped_per_particle());
    EXPECT_NEAR(dropped.mean(), std::log(N) + 0.57721566, 4 * dropped.error());
    EXPECT_NEAR(dropped.error() * std::sqrt(2000), 1.2825, 0.15);  // pi/sqrt(6)
}

TEST(FlawSampler, MeanNumberOfFlawsAndTheirThresholds) {
    constexpr std::uint64_t N = 100000;
    const double volume = 1.1e-4, per_particle = volume / N;  // the 6 cm sphere of Nakamura & Fujiwara
    const FlawSampler sampler(basalt_flaws, volume, N, 1, 0);
    const double X = sampler.dropped_per_particle();
    Moments count;
    std::vector<float> thresholds;
    for (std::uint64_t id = 0; id < N; ++id) {
        const Flaws flaws = sampler.sample(id);
        ASSERT_GE(flaws.count, 1u);
        count.add(flaws.count);
        thresholds.push_back(flaws.threshold);
    }
    EXPECT_NEAR(count.mean(), sampler.mean_count(), 4 * std::sqrt(X / N));
    EXPECT_NEAR(count.error() * std::sqrt(N), std::sqrt(X), 0.05);  // Poisson
    // The weakest flaw: P(threshold < eps) = (1 - exp(-k V/N eps^m)) / (1 - e^-X).
    std::sort(thresholds.begin(), thresholds.end());
    for (const double expected_flaws : {1e-3, 1e-2, 0.1, 0.5, 1.0, 2.0, 5.0}) {
        const double eps = std::pow(expected_flaws / (4e35 * per_particle), 1.0 / 9);
        const double p = std::expm1(-expected_flaws) / std::expm1(-X);
        const double below = static_cast<double>(
            std::lower_bound(thresholds.begin(), thresholds.end(), static_cast<float>(eps)) -
            thresholds.begin());
        EXPECT_NEAR(below / N, p, 4 * std::sqrt(p * (1 - p) / N)) << expected_flaws;
    }
    // The weakest flaw of the whole body is about the one with k V eps^m = 1.
    const double weakest = 4e35 * volume * std::pow(static_cast<double>(thresholds.front()), 9);
    EXPECT_GT(weakest, 1e-4);
    EXPECT_LT(weakest, 10);
}

TEST(FlawSampler, DependsOnIdSeedAndBodyOnly) {
    const FlawSampler one(basalt_flaws, 1e-4, 1000, 5, 0), same(basalt_flaws, 1e-4, 1000, 5, 0);
    const FlawSampler seed(basalt_flaws, 1e-4, 1000, 6, 0), body(basalt_flaws, 1e-4, 1000, 5, 1);
    const auto equal = [](const Flaws& a, const Flaws& b) {
        return a.threshold == b.threshold && a.exponent == b.exponent && a.count == b.count;
    };
    for (std::uint64_t id = 0; id < 50; ++id) {
        EXPECT_TRUE(equal(one.sample(id), same.sample(49 - (49 - id))));
        EXPECT_FALSE(equal(one.sample(id), seed.sample(id)));
        EXPECT_FALSE(equal(one.sample(id), body.sample(id)));
        EXPECT_FALSE(equal(one.sample(id), one.sample(id + 1)));
    }
}

/// Benz & Asphaug's own procedure: flaws dropped on random particles until each has one.
std::vector<std::vector<double>> drop_flaws(const Fracture& fracture, double volume, std::uint64_t particles,
                                            std::uint64_t seed) {
    const RandomStream stream{.seed = seed};
    std::vector<std::vector<double>> flaws(particles);
    std::uint64_t still = particles;
    for (std::uint64_t j = 1; still > 0; ++j) {
        const auto i = static_cast<std::size_t>(stream.uniform(j, 0) * static_cast<double>(particles));
        still -= flaws[i].empty();
        flaws[i].push_back(
            std::pow(static_cast<double>(j) / (fracture.weibull_k * volume), 1 / fracture.weibull_m));
    }
    return flaws;
}

TEST(FlawSampler, HasTheJointStatisticsOfDroppedFlaws) {
    constexpr std::uint64_t N = 5000;
    constexpr int bodies = 40;
    const double volume = 1e-4, per_particle = volume / N;
    // Means over many bodies of: number of flaws, and those open at strains with this many to expect.
    const std::vector<double> expected = {0.03, 0.1, 0.5, 1, 2, 4, 8};
    std::vector<Moments> sampled(expected.size() + 2), dropped(expected.size() + 2);
    std::vector<Moments> exact(expected.size());
    const auto strain = [&](double flaws) { return std::pow(flaws / (4e35 * per_particle), 1.0 / 9); };
    for (std::uint64_t seed = 0; seed < bodies; ++seed) {
        const FlawSampler sampler(basalt_flaws, volume, N, seed, 3);
        const auto reference = drop_flaws(basalt_flaws, volume, N, seed);
        std::vector<double> mean_sampled(sampled.size(), 0), mean_dropped(sampled.size(), 0),
            mean_exact(expected.size(), 0);
        for (std::uint64_t id = 0; id < N; ++id) {
            const auto& all = reference[id];
            Flaws compact{static_cast<float>(all.front()), 1, static_cast<std::uint32_t>(all.size())};
            if (all.size() > 1)
                compact.exponent =
                    static_cast<float>(std::log(all.size()) / std::log(all.back() / all.front()));
            const Flaws flaws = sampler.sample(id);
            const auto collect = [&](std::vector<double>& mean, const Flaws& f) {
                for (std::size_t k = 0; k < expected.size(); ++k) mean[k] += f.open(strain(expected[k])) / N;
                mean[expected.size()] += static_cast<double>(f.count) / N;
                mean[expected.size() + 1] += std::log(static_cast<double>(f.threshold)) / N;
            };
            collect(mean_sampled, flaws);
            collect(mean_dropped, compact);
            for (std::size_t k = 0; k < expected.size(); ++k)
                mean_exact[k] +=
                    static_cast<double>(std::count_if(all.begin(), all.end(),
                                                      [&](double e) { return e < strain(expected[k]); })) /
                    N;
        }
        for (std::size_t k = 0; k < sampled.size(); ++k) {
            sampled[k].add(mean_sampled[k]);
            dropped[k].add(mean_dropped[k]);
        }
        // Dropped flaws follow Weibull, n = k V eps^m per particle, as far as flaws go at all.
        for (std::size_t k = 0; k < expected.size(); ++k) exact[k].add(mean_exact[k]);
    }
    for (std::size_t k = 0; k < sampled.size(); ++k) {
        const double error = std::hypot(sampled[k].error(), dropped[k].error());
        EXPECT_NEAR(sampled[k].mean(), dropped[k].mean(), 4 * error + 1e-3 * std::abs(dropped[k].mean()))
            << k;
    }
    for (std::size_t k = 0; k + 2 < expected.size(); ++k) {
        EXPECT_NEAR(exact[k].mean(), expected[k], 4 * exact[k].error() + 2.0 / N) << k;
        RecordProperty("compact_over_weibull_at_" + std::to_string(expected[k]),
                       std::to_string(sampled[k].mean() / expected[k]));
    }
}

/// Columns of `count` equal particles of one dimension, pulled along x by the stress `sigma`.
struct Pulled {
    std::vector<float> threshold, exponent;
    std::vector<std::uint32_t> flaws;
    std::vector<double> pressure, sxx, radius, damage;
    std::vector<std::uint8_t> body;

    Pulled(std::size_t count, Flaws f, double sigma)
        : threshold(count, f.threshold),
          exponent(count, f.exponent),
          flaws(count, f.count),
          pressure(count, -sigma / 3),
          sxx(count, 2 * sigma / 3),
          radius(count, 1e-3),
          damage(count, 0),
          body(count, 0) {}
    FractureState state() { return {{threshold, exponent, flaws}, pressure, {1, {sxx.data()}}, radius, 2.0}; }
};

TEST(Damage, PartialActivationGivesPartialDamage) {
    // 1 of 8 flaws open: in whole numbers 1/8 is 0, and no damage would grow until all are open.
    const CrackGrowth growth = basalt().crack_growth();
    const Flaws flaws{.threshold = 1e-3f, .exponent = 3, .count = 8};
    const DamageRate rate = damage_rate(growth, flaws, 1.0000001e-3, 2e-3);
    EXPECT_NEAR(rate.rate, growth.crack_speed / 2e-3, 1e-5 * rate.rate);
    EXPECT_NEAR(rate.limit, 0.5, 1e-5);
    Pulled rock(1, flaws, 1.0000001e-3 * growth.young_modulus);
    grow_damage(growth, rock.state(), 1, rock.damage, rock.body, 0);
    EXPECT_NEAR(rock.damage[0], 0.5, 1e-5);
    Pulled more(1, flaws, 3e-3 * growth.young_modulus);
    grow_damage(growth, more.state(), 1, more.damage, more.body, 0);
    EXPECT_EQ(more.damage[0], 1);
}

TEST(Damage, GrowsAsCracksOfOneSpeed) {
    const CrackGrowth growth = basalt().crack_growth();
    const Flaws flaws{.threshold = 1e-3f, .exponent = 9, .count = 8};
    Pulled once(1, flaws, 5e-3 * growth.young_modulus), often = once;
    const double time = 0.3 * 2e-3 / growth.crack_speed;  // 8 cracks over 0.3 R_s: D = 8 * 0.3^3
    grow_damage(growth, once.state(), time, once.damage, once.body, 0);
    for (int i = 0; i < 10; ++i) grow_damage(growth, often.state(), time / 10, often.damage, often.body, 0);
    EXPECT_NEAR(once.damage[0], 8 * 0.027, 1e-12);
    EXPECT_NEAR(often.damage[0], 8 * 0.027, 1e-12);
    CrackGrowth printed = growth;
    printed.crack_count_power = 1;
    EXPECT_NEAR(damage_rate(printed, flaws, 5e-3, 1).rate, 8 * growth.crack_speed, 1e-9);
}

TEST(Damage, NeitherShrinksNorLeavesItsBodyNorGrowsUnderPressure) {
    const CrackGrowth growth = basalt().crack_growth();
    Pulled rock(4, {.threshold = 1e-3f, .exponent = 3, .count = 8}, 1.001e-3 * growth.young_modulus);
    rock.damage = {0.7, 0, 0, 1};
    rock.body = {0, 1, 0, 0};
    rock.pressure[2] = 1e9;
    grow_damage(growth, rock.state(), 1, rock.damage, rock.body, 0);
    EXPECT_EQ(rock.damage, (std::vector<double>{0.7, 0, 0, 1}));
}

TEST(Damage, TimeStepIsTheOneThatGrowsAsMuchAsAllowed) {
    const CrackGrowth growth = basalt().crack_growth();
    for (const double start : {0.0, 0.3, 0.7}) {
        Pulled rock(1, {.threshold = 1e-3f, .exponent = 3, .count = 8}, 5e-3 * growth.young_modulus);
        rock.damage[0] = start;
        const double dt = damage_time_step(growth, rock.state(), 0.1, rock.damage, rock.body, 0);
        grow_damage(growth, rock.state(), dt, rock.damage, rock.body, 0);
        EXPECT_NEAR(std::cbrt(rock.damage[0]), std::cbrt(start) + 0.1, 1e-12);
    }
    Pulled rock(1, {.threshold = 1e-3f, .exponent = 3, .count = 8}, 5e-3 * growth.young_modulus);
    rock.damage[0] = 0.95;
    EXPECT_TRUE(std::isinf(damage_time_step(growth, rock.state(), 0.1, rock.damage, rock.body, 0)));
    rock.damage[0] = 0;
    EXPECT_TRUE(std::isinf(damage_time_step(growth, rock.state(), 0.1, rock.damage, rock.body, 1)));
    rock.pressure[0] = 1e10;
    EXPECT_TRUE(std::isinf(damage_time_step(growth, rock.state(), 0.1, rock.damage, rock.body, 0)));
}

test::PulledRock pulled_basalt(double spacing) {
    const CrackGrowth growth = basalt().crack_growth();
    const double volume = spacing * spacing * spacing;
    return {.young_modulus = growth.young_modulus,
            .crack_speed = growth.crack_speed,
            .weibull_k = 4e35,
            .weibull_m = 9,
            .volume = volume,
            .radius = std::cbrt(3 * volume / (4 * std::numbers::pi))};
}

TEST(GradyKipp, StrengthRisesWithTheRateAsThePowerLaw) {
    const test::PulledRock rock = pulled_basalt(1e-3), coarse = pulled_basalt(1e-1);
    for (const double rate : {1.0, 100.0, 1e4}) {
        const double exponent = std::log10(test::classic_failure_stress(rock, 10 * rate) /
                                           test::classic_failure_stress(rock, rate));
        EXPECT_NEAR(exponent, 3.0 / 12, 1e-12);
        EXPECT_NEAR(std::log10(test::many_flaw_failure_stress(rock, 10 * rate) /
                               test::many_flaw_failure_stress(rock, rate)),
                    3.0 / 12, 1e-12);
        // The cube-root law differs from the sum over growing spheres by a constant near 1, at any size.
        const double ratio =
            test::many_flaw_failure_stress(rock, rate) / test::classic_failure_stress(rock, rate);
        EXPECT_NEAR(ratio, std::pow(std::pow(4.0, 3) * 6 / (10.0 * 11 * 12), 1.0 / 12), 1e-12);
        EXPECT_NEAR(test::many_flaw_failure_stress(coarse, rate) / test::many_flaw_failure_stress(rock, rate),
                    1, 1e-12);
    }
    // With n for its cube root the exponent is another and the size of the element matters.
    test::PulledRock printed = rock, printed_coarse = coarse;
    printed.power = printed_coarse.power = 1;
    EXPECT_NEAR(
        std::log10(test::many_flaw_failure_stress(printed, 10) / test::many_flaw_failure_stress(printed, 1)),
        1.0 / 10, 1e-12);
    EXPECT_LT(test::many_flaw_failure_stress(printed_coarse, 1),
              0.5 * test::many_flaw_failure_stress(printed, 1));
}

// Between about 0.1 and 10 open flaws a particle: below, single flaws decide; above, the ln N + 0.577 flaws
// of a particle are all open.
TEST(GradyKipp, SampledFlawsBreakAtItsStress) {
    const double spacing = 5e-3;
    test::PulledRock rock = pulled_basalt(spacing);
    constexpr std::uint64_t N = 2000;
    const FlawSampler sampler({.weibull_k = 4e35, .weibull_m = 9}, N * rock.volume, N, 1, 0);
    std::vector<Flaws> particles;
    for (std::uint64_t id = 0; id < N; ++id) particles.push_back(sampler.sample(id));
    for (const double rate : {100.0, 300.0, 1000.0}) {
        const double theory = test::many_flaw_failure_stress(rock, rate);
        const double last = 3 * theory / rock.young_modulus;
        const double bounded = test::failure_stress(test::pull<Flaws>(rock, particles, rate, last, 1500));
        const double free = test::failure_stress(test::pull<Flaws>(rock, particles, rate, last, 1500, false));
        RecordProperty("stress_over_theory_at_rate_" + std::to_string(static_cast<int>(rate)),
                       std::to_string(bounded / theory) + " bounded, " + std::to_string(free / theory) +
                           " free, " + std::to_string(theory / 1e6) + " MPa, flaws open " +
                           std::to_string(4e35 * rock.volume * std::pow(theory / rock.young_modulus, 9)));
        EXPECT_NEAR(free / theory, 1, 0.15) << rate;
        EXPECT_NEAR(bounded / theory, 1, 0.17) << rate;
    }
}

TEST(GradyKipp, OneFlawBreaksByItsCrackAlone) {
    const test::PulledRock rock = pulled_basalt(1e-3);
    const Flaws flaw{.threshold = 1e-3f, .exponent = 1, .count = 1};
    for (const double rate : {1.0, 100.0, 1e4}) {
        const double theory = test::one_flaw_failure_stress(rock, static_cast<double>(flaw.threshold), rate);
        const double last = 2 * theory / rock.young_modulus;
        const double pulled = test::failure_stress(test::pull<Flaws>(rock, {&flaw, 1}, rate, last, 200000));
        EXPECT_NEAR(pulled / theory, 1, 1e-4) << rate;
        EXPECT_GE(theory, 1e-3 * rock.young_modulus);
    }
}

TEST(GradyKipp, GrowDamageFollowsTheReference) {
    const test::PulledRock rock = pulled_basalt(1e-3);
    const Flaws flaws{.threshold = 1e-3f, .exponent = 6, .count = 20};
    const double rate = 100, last = 4e-3;
    constexpr int steps = 2000;
    const auto curve = test::pull<Flaws>(rock, {&flaws, 1}, rate, last, steps);
    Pulled particle(1, flaws, 0);
    particle.radius[0] = rock.radius / 2;  // the factor is 2
    for (int s = 0; s < steps; ++s) {
        const double sigma = rock.young_modulus * (s + 0.5) * last / steps;
        particle.pressure[0] = -sigma / 3;
        particle.sxx[0] = 2 * sigma / 3;
        grow_damage(basalt().crack_growth(), particle.state(), last / steps / rate, particle.damage,
                    particle.body, 0);
        ASSERT_NEAR(particle.damage[0], curve[static_cast<std::size_t>(s)].damage, 1e-12);
    }
    EXPECT_GT(particle.damage[0], 0.5);
}

}  // namespace
}  // namespace talus
