#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "comm/exact_sum.hpp"
#include "tests/support/solid_scene.hpp"

/// runs/rotating_sphere: a turning sphere keeps its angular momentum and has no stress but what the
/// centrifugal force needs.
namespace talus::test {
namespace {

struct Stress {
    double mean_pressure, deviatoric;  ///< mean over the volume; root mean square of sqrt(J2) [Pa]
};

Stress measure(const Simulation& run) {
    const ParticleSet& particles = run.particles();
    std::vector<ExactSum> sums(3);
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const double size = particles.data(field::mass)[i] / particles.data(field::predicted_density)[i];
        double s2 = 0;
        for (int c = 0; c < 6; ++c) {
            const double s = particles.data(field::predicted_stress, c)[i];
            s2 += (c < 3 ? 0.5 : 1.0) * s * s;
        }
        sums[0].add(size);
        sums[1].add(size * particles.data(field::pressure)[i]);
        sums[2].add(size * s2);
    }
    ExactSum::all_reduce(run.comm(), sums);
    return {sums[1].value() / sums[0].value(), std::sqrt(sums[2].value() / sums[0].value())};
}

TEST(RotatingSphere, KeepsAngularMomentumAndStaysFreeOfStress) {
    const Communicator comm = world();
    const SceneSetup scene = solid_scene(comm, "rotating_sphere");
    const Material& material = scene.simulation.materials[0];
    const double spin = scene.bodies[0].spin[2];
    const double centrifugal =
        material.reference_density * spin * spin;  // times the radius squared, which is 1
    const auto run = started(comm, scene);
    const Totals before = run->totals();
    double count = 0, pressure = 0, deviatoric = 0;  // over the second half: the start shakes the sphere
    while (run->time() < scene.output.end_time) {
        run->step();
        if (run->time() < 0.5 * scene.output.end_time || run->step_count() % 10 != 0) continue;
        const Stress now = measure(*run);
        count += 1;
        pressure += now.mean_pressure;
        deviatoric = std::max(deviatoric, now.deviatoric);
    }
    pressure /= count;
    const Totals after = run->totals();
    const double change = after.angular_momentum[2] / before.angular_momentum[2] - 1;
    if (comm.is_root())
        fmt::print("| {:g} | {:.2f} | {:+.1e} | {:+.1e} | {:.3f} / {:.3f} | {:.3f} | {:.1e} |\n",
                   scene.bodies[0].spacing, run->time() * spin / 6.283185307179586, change,
                   after.kinetic_energy / before.kinetic_energy - 1, -pressure / centrifugal, 2.0 / 15,
                   deviatoric / centrifugal, deviatoric / material.shear_modulus);

    // The deviatoric forces between pairs are not central, so nothing keeps the angular momentum exactly.
    EXPECT_NEAR(change, 0, 3e-3);
    EXPECT_NEAR(after.kinetic_energy / before.kinetic_energy, 1, 3e-3);
    // Virial theorem: the mean pressure is -2/3 of the kinetic energy per volume, 2/15 rho (spin radius)^2.
    // It acts on less than the volume, since surfaces bear less stress over 0.6 spacings: a factor of 1.5
    // here.
    EXPECT_GT(-pressure / centrifugal, 0.9 * 2 / 15);
    EXPECT_LT(-pressure / centrifugal, 1.6 * 2 / 15);
    EXPECT_LT(deviatoric, 0.25 * centrifugal);
}

}  // namespace
}  // namespace talus::test
