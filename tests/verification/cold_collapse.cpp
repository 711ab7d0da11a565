#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "comm/exact_sum.hpp"
#include "src/simulation.hpp"

/// An even ball of gas without pressure falls together, every shell alike: r/r0 = cos^2 x with x + sin(2x)/2
/// = sqrt(2 G M/r0^3) t. Units: G, mass and first radius are 1.
namespace talus::test {
namespace {

constexpr double spacing = 0.1;

ParticleSet ball(const Communicator& comm, const Setup& setup) {
    ParticleSet particles("gas", 3);
    add_fields(particles, setup);
    std::vector<std::array<double, 3>> places;
    const int reach = static_cast<int>(1 / spacing) + 1;
    for (int z = -reach; z < reach; ++z)
        for (int y = -reach; y < reach; ++y)
            for (int x = -reach; x < reach; ++x) {
                const std::array<double, 3> at{(x + 0.5) * spacing, (y + 0.5) * spacing, (z + 0.5) * spacing};
                if (std::hypot(at[0], at[1], at[2]) < 1) places.push_back(at);
            }
    particles.resize(comm.is_root() ? places.size() : 0);
    for (std::size_t i = 0; i < particles.size(); ++i) {
        particles.data(field::id)[i] = i;
        for (int a = 0; a < 3; ++a)
            particles.data(field::position, a)[i] = places[i][static_cast<std::size_t>(a)];
        particles.data(field::mass)[i] = 1 / static_cast<double>(places.size());
        particles.data(field::smoothing_length)[i] = spacing;
        particles.data(field::internal_energy)[i] = 1e-6;
    }
    return particles;
}

double mean_square_radius(const Simulation& run) {
    std::vector<ExactSum> sum(1);
    for (int a = 0; a < 3; ++a)
        for (const double x : run.particles().own(field::position, a)) sum[0].add(x * x);
    ExactSum::all_reduce(run.comm(), sum);
    return sum[0].value() / static_cast<double>(run.total_particles());
}

TEST(ColdCollapse, FollowsTheShellsOfFreeFall) {
    const Communicator comm = world();
    talus::Setup setup;
    setup.sph.density = sph::DensityMethod::summation;
    setup.sph.variable_smoothing_length = true;
    setup.sph.riemann_velocity = true;
    setup.materials = {{.name = "gas", .eos = IdealGas{}, .reference_density = 1}};
    setup.gravity.emplace();
    setup.gravity->constant = 1;
    Simulation run(comm, setup, ball(comm, setup));
    run.start();
    const double first_size = mean_square_radius(run), first_energy = run.totals().total_energy();
    if (comm.is_root()) fmt::print("| free fall | size | exact | energy |\n");
    for (const double angle : {0.5, 0.8}) {
        const double time = (angle + 0.5 * std::sin(2 * angle)) / std::sqrt(2.0);
        double before = run.time(), size_before = mean_square_radius(run);
        while (run.time() < time) {
            before = run.time();
            size_before = mean_square_radius(run);
            run.step();
        }
        const double share = (time - before) / (run.time() - before);
        const double size =
            std::sqrt(((1 - share) * size_before + share * mean_square_radius(run)) / first_size);
        const double exact = std::cos(angle) * std::cos(angle);
        const Totals totals = run.totals();
        if (comm.is_root())
            fmt::print("| {:.2f} | {:.4f} | {:.4f} | {:.1e} |\n", time / (M_PI / 2 / std::sqrt(2.0)), size,
                       exact, totals.total_energy() / first_energy - 1);
        // Softened and made of lumps, the ball falls late: by less than 2 % of the time to its centre.
        const double speed = std::sqrt(2 * (1 / exact - 1)), free_fall = M_PI / 2 / std::sqrt(2.0);
        EXPECT_NEAR(size, exact, 0.02 * free_fall * speed);
        EXPECT_NEAR(totals.total_energy() / first_energy, 1, 5e-3) << "the force of a changing h is left out";
    }
    EXPECT_NEAR(first_energy, -0.6, 0.01) << "-3/5 G M^2/R of a ball, less the softening";
}

}  // namespace
}  // namespace talus::test
