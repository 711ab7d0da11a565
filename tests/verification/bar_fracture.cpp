#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "src/run/commands.hpp"
#include "src/setup/scene_setup.hpp"
#include "tests/support/grady_kipp_reference.hpp"

/// runs/bar_fracture: the stress at which a pulled bar breaks, against Grady and Kipp's. And the flaws that a
/// scene gives its particles.
namespace talus::test {
namespace {

SceneSetup bar_scene(const Communicator& comm) {
    RunOptions options;
    options.scene = TALUS_SOURCE_DIR "/runs/bar_fracture";
    const Scene scene = load_scene(comm, options);
    return read_scene(comm, scene);
}

double sum_over_ranks(const Communicator& comm, double share) {
    double sum = 0;
    for (const double part : comm.all_gather(std::span<const double>(&share, 1))) sum += part;
    return sum;
}

PulledRock rock_of(const SceneSetup& scene) {
    const Material& material = scene.simulation.materials[0];
    const CrackGrowth growth = material.crack_growth();
    const double spacing = scene.bodies[0].spacing;
    return {.young_modulus = growth.young_modulus,
            .crack_speed = growth.crack_speed,
            .weibull_k = material.fracture->weibull_k,
            .weibull_m = material.fracture->weibull_m,
            .volume = spacing * spacing * spacing,
            .radius = scene.simulation.sph.kernel_support() * scene.simulation.sph.eta * spacing,
            .power = material.fracture->crack_count_power};
}

/// The particles whose stress is measured: the middle 40 % of the bar.
bool in_the_middle(const ParticleSet& particles, std::size_t i, const BoxShape& bar) {
    return std::abs(particles.data(field::position)[i]) < 0.4 * bar.upper[0];
}

std::vector<Flaws> flaws_in_the_middle(const Communicator& comm, const ParticleSet& particles,
                                       const BoxShape& bar) {
    std::vector<Flaws> mine;
    for (std::size_t i = 0; i < particles.size(); ++i)
        if (in_the_middle(particles, i, bar))
            mine.push_back({particles.data(field::flaw_threshold)[i], particles.data(field::flaw_exponent)[i],
                            particles.data(field::flaw_count)[i]});
    return comm.all_gather(std::span<const Flaws>(mine));
}

struct Breaking {
    double measured, homogeneous, classic;  // largest mean stress [Pa]
    double open;                            // flaws to expect in a particle at the measured stress
    double damage;                          // mean, at the largest stress
};

double poisson_ratio(const Material& material) {
    const double K = material.bulk_modulus, mu = material.shear_modulus;
    return (3 * K - 2 * mu) / (2 * (3 * K + mu));
}

/// The scene's bar at another strain rate, 60 x 6 x 6 particles in size, with a time step that resolves
/// failure.
SceneSetup bar(SceneSetup scene, double rate, double spacing) {
    Body& body = scene.bodies[0];
    body.spacing = spacing;
    body.shape =
        BoxShape{{-30 * spacing, -3 * spacing, -3 * spacing}, {30 * spacing, 3 * spacing, 3 * spacing}};
    const Material& material = scene.simulation.materials[0];
    const double across = -poisson_ratio(material) * rate;
    body.velocity_field = StretchVelocity{{}, {rate, across, across}};
    const PulledRock rock = rock_of(scene);
    const double failure_time = many_flaw_failure_stress(rock, rate) / (rock.young_modulus * rate);
    const double h = scene.simulation.sph.eta * spacing;
    scene.simulation.sph.courant = std::min(0.4, failure_time / 50 * material.longitudinal_speed() / h);
    return scene;
}

/// Pulls a bar until the stress has fallen.
Breaking break_bar(const Communicator& comm, const SceneSetup& scene) {
    const BoxShape shape = std::get<BoxShape>(scene.bodies[0].shape);
    const double rate = std::get<StretchVelocity>(scene.bodies[0].velocity_field).rate[0];
    const PulledRock rock = rock_of(scene);
    const double strength = many_flaw_failure_stress(rock, rate);
    Simulation run(comm, scene.simulation, make_particles(comm, scene));
    const std::vector<Flaws> flaws = flaws_in_the_middle(comm, run.particles(), shape);
    run.start();

    Breaking result{};
    result.classic = classic_failure_stress(rock, rate);
    result.homogeneous =
        failure_stress(pull<Flaws>(rock, flaws, rate, 6 * strength / rock.young_modulus, 6000));
    const double longest = 20 * strength / (rock.young_modulus * rate);
    for (double now = 0; now >= 0.85 * result.measured && run.time() < longest;) {
        run.step();
        const ParticleSet& particles = run.particles();
        double stress = 0, damage = 0, count = 0;
        for (std::size_t i = 0; i < particles.size(); ++i)
            if (in_the_middle(particles, i, shape)) {
                stress += particles.data(field::predicted_stress)[i] - particles.data(field::pressure)[i];
                damage += particles.data(field::damage)[i];
                ++count;
            }
        count = sum_over_ranks(comm, count);
        now = sum_over_ranks(comm, stress) / count;
        damage = sum_over_ranks(comm, damage) / count;
        if (now > result.measured) {
            result.measured = now;
            result.damage = damage;
        }
    }
    result.open =
        rock.weibull_k * rock.volume * std::pow(result.measured / rock.young_modulus, rock.weibull_m);
    return result;
}

void print_row(const Communicator& comm, double spacing, double rate, const Breaking& broke) {
    if (comm.is_root())
        fmt::print("| {:g} | {:g} | {:.3g} | {:.2f} | {:.2f} | {:+.1f} % | {:.2f} | {:.2f} | {:.3f} |\n",
                   1e3 * spacing, rate, broke.open, broke.measured / 1e6, broke.homogeneous / 1e6,
                   100 * (broke.measured / broke.homogeneous - 1), broke.classic / 1e6,
                   broke.measured / broke.classic, broke.damage);
}

/// Every particle pulled as the bar is, on its own: this holds while waves cross few particles before the bar
/// breaks, c_L t < 20 spacings here (rates above 20/s); slower bars break earlier, as broken particles load
/// others.
TEST(BarFracture, BreaksAtTheStressOfItsFlawsAtAnyRate) {
    const Communicator world(MPI_COMM_WORLD);
    std::vector<double> strengths;
    for (const double rate : {30.0, 300.0, 3000.0}) {
        const SceneSetup scene = bar(bar_scene(world), rate, 5e-3);
        const Breaking broke = break_bar(world, scene);
        print_row(world, scene.bodies[0].spacing, rate, broke);
        EXPECT_NEAR(broke.measured / broke.homogeneous, 1, 0.03) << rate;
        strengths.push_back(broke.measured);
    }
    EXPECT_TRUE(std::is_sorted(strengths.begin(), strengths.end()));
}

/// Grady and Kipp's law: strength ~ rate^(3/(m+3)). A particle follows it between 0.1 and a few open flaws, a
/// factor of 7 in the rate; over more, the particles have to grow with the distance that cracks run.
TEST(BarFracture, StrengthRisesWithTheRateAsGradyAndKippSay) {
    const Communicator world(MPI_COMM_WORLD);
    std::vector<double> strengths;
    for (const double rate : {1.0, 10.0, 100.0}) {
        SceneSetup scene = bar(bar_scene(world), rate, 5e-3 * std::pow(200 / rate, 0.75));
        scene.seed = static_cast<std::uint64_t>(rate);
        const Breaking broke = break_bar(world, scene);
        print_row(world, scene.bodies[0].spacing, rate, broke);
        EXPECT_NEAR(broke.measured / broke.homogeneous, 1, 0.03) << rate;
        const PulledRock rock = rock_of(scene);
        const std::vector<ListedFlaws> dealt = deal_flaws(rock, 2160, 1);
        const double last_strain = 3 * broke.measured / rock.young_modulus;
        const double expected = failure_stress(pull<ListedFlaws>(rock, dealt, rate, last_strain, 3000));
        // A particle of the bar knows its weakest flaw, their number and an exponent: 4 % less than every
        // flaw.
        EXPECT_NEAR(broke.measured / expected, 1, 0.05) << rate;
        if (world.is_root()) fmt::print("flaws dealt anew: {:.2f} MPa\n", expected / 1e6);
        strengths.push_back(broke.measured);
    }
    const double m = rock_of(bar_scene(world)).weibull_m;
    EXPECT_NEAR(std::log10(strengths[2] / strengths[0]) / 2, 3 / (m + 3), 0.01);
}

/// With friction on cracks damage takes the shear only when the strength has fallen below it.
TEST(BarFracture, FrictionKeepsShearUntilTheStrengthIsGone) {
    const Communicator world(MPI_COMM_WORLD);
    SceneSetup scene = bar(bar_scene(world), 100, 5e-3);
    const Breaking brittle = break_bar(world, scene);
    scene.simulation.materials[0].strength =
        Lundborg{.cohesion = 1e8, .limit = 3.5e9, .friction_intact = 1.5, .friction_damaged = 0.8};
    const Breaking frictional = break_bar(world, scene);
    print_row(world, scene.bodies[0].spacing, 100, frictional);
    EXPECT_GT(frictional.measured, 1.02 * brittle.measured);
    EXPECT_LT(frictional.measured, 1.5 * brittle.measured);
}

/// The flaws that a whole scene gives its particles.
TEST(FlawsOfAScene, AreThoseOfTheTheory) {
    const Communicator world(MPI_COMM_WORLD);
    RunOptions options;
    options.scene = TALUS_SOURCE_DIR "/runs/basalt_impact";
    options.quick = true;
    SceneSetup scene = read_scene(world, load_scene(world, options));
    const Fracture& fracture = *scene.simulation.materials[0].fracture;
    const auto N = static_cast<double>(scene.census[0].count);
    const double flaws_per_strain = fracture.weibull_k * scene.census[0].particle_volume;
    constexpr int seeds = 40;
    double mean_of_means = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
        scene.seed = static_cast<std::uint64_t>(seed);
        const ParticleSet particles = make_particles(world, scene);
        std::vector<double> opened, flaws;  // flaws expected in a particle below the threshold of its weakest
        for (std::size_t i = 0; i < particles.size(); ++i) {
            const double threshold = static_cast<double>(particles.data(field::flaw_threshold)[i]);
            const double count = particles.data(field::flaw_count)[i];
            if (particles.data(field::body)[i] != 0) {
                EXPECT_EQ(count, 0) << "the projectile does not crack";
                continue;
            }
            opened.push_back(flaws_per_strain * std::pow(threshold, fracture.weibull_m));
            flaws.push_back(count);
        }
        opened = world.all_gather(std::span<const double>(opened));
        flaws = world.all_gather(std::span<const double>(flaws));
        ASSERT_EQ(opened.size(), N);
        mean_of_means += std::accumulate(flaws.begin(), flaws.end(), 0.0) / N / seeds;
        EXPECT_GE(*std::min_element(flaws.begin(), flaws.end()), 1) << "every particle has a flaw";
        // Weakest thresholds: 1 - exp(-k V eps^m). Kolmogorov's distance, exceeded by chance once in 1e5.
        std::sort(opened.begin(), opened.end());
        double distance = 0;
        for (std::size_t i = 0; i < opened.size(); ++i)
            distance =
                std::max(distance, std::abs((static_cast<double>(i) + 0.5) / N + std::expm1(-opened[i])));
        EXPECT_LT(distance * std::sqrt(N), 2.5) << "seed " << seed;
    }
    // ln N + 0.577, the coupon collector's; its spread between bodies is pi/sqrt(6).
    EXPECT_NEAR(mean_of_means, std::log(N) + 0.5772, 3.5 * 1.283 / std::sqrt(seeds));
    if (world.is_root())
        fmt::print("flaws per particle {:.2f}, theory {:.2f}\n", mean_of_means, std::log(N) + 0.5772);
}

}  // namespace
}  // namespace talus::test
