#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

/// The particles whose stress is measured: the middle half of the bar.
bool in_the_middle(const ParticleSet& particles, std::size_t i, const BoxShape& bar) {
    return std::abs(particles.data(field::position)[i]) < 0.5 * bar.upper[0];
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
    double open;                            // flaws per particle open at the classic stress
    double damage;                          // mean, at the largest stress
};

/// Pulls the scene's bar, with a time step that resolves the failure, until the stress has fallen.
Breaking break_bar(const Communicator& comm, SceneSetup scene, double rate) {
    const BoxShape bar = std::get<BoxShape>(scene.bodies[0].shape);
    const Material& material = scene.simulation.materials[0];
    const PulledRock rock = rock_of(scene);
    const double K = material.bulk_modulus, mu = material.shear_modulus;
    const double poisson = (3 * K - 2 * mu) / (2 * (3 * K + mu));
    scene.bodies[0].velocity_field = StretchVelocity{{}, {rate, -poisson * rate, -poisson * rate}};
    const double strength = many_flaw_failure_stress(rock, rate);
    const double failure_time = strength / (rock.young_modulus * rate);
    scene.simulation.sph.courant = std::min(0.4, failure_time / 80 * material.longitudinal_speed() /
                                                     (scene.simulation.sph.eta * scene.bodies[0].spacing));
    Simulation run(comm, scene.simulation, make_particles(comm, scene));
    const std::vector<Flaws> flaws = flaws_in_the_middle(comm, run.particles(), bar);
    run.start();

    Breaking result{};
    result.classic = classic_failure_stress(rock, rate);
    result.open =
        rock.weibull_k * rock.volume * std::pow(result.classic / rock.young_modulus, rock.weibull_m);
    result.homogeneous = failure_stress(pull(rock, flaws, rate, 6 * strength / rock.young_modulus, 6000));
    for (double now = 0; now >= 0.85 * result.measured && run.time() < 20 * failure_time;) {
        run.step();
        const ParticleSet& particles = run.particles();
        double stress = 0, damage = 0, count = 0;
        for (std::size_t i = 0; i < particles.size(); ++i)
            if (in_the_middle(particles, i, bar)) {
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
    return result;
}

void print_row(const Communicator& comm, double spacing, double rate, const Breaking& broke) {
    if (comm.is_root())
        fmt::print("| {:g} | {:g} | {:.3g} | {:.2f} | {:.2f} | {:+.1f} % | {:.2f} | {:.2f} | {:.3f} |\n",
                   1e3 * spacing, rate, broke.open, broke.measured / 1e6, broke.homogeneous / 1e6,
                   100 * (broke.measured / broke.homogeneous - 1), broke.classic / 1e6,
                   broke.measured / broke.classic, broke.damage);
}

TEST(BarFracture, BreaksAtTheStressOfItsFlawsAtAnyRate) {
    const Communicator world(MPI_COMM_WORLD);
    for (const double rate : {10.0, 30.0, 100.0, 300.0, 1000.0}) {
        const SceneSetup scene = bar_scene(world);
        const Breaking broke = break_bar(world, scene, rate);
        print_row(world, scene.bodies[0].spacing, rate, broke);
        EXPECT_NEAR(broke.measured / broke.homogeneous, 1, 0.1) << rate;
    }
}

}  // namespace
}  // namespace talus::test
