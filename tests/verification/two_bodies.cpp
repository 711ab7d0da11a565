#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "src/simulation.hpp"

/// Two particles on Kepler's ellipse about each other, with a fluid that does not press.
namespace talus::test {
namespace {

struct Orbit {
    double energy_drift, period_error, distance_error;
};

Orbit run_orbit(const Communicator& comm, double eccentricity, double step_factor) {
    Setup setup;
    setup.gravity.emplace();
    setup.gravity->step_factor = step_factor;
    setup.sph.density = sph::DensityMethod::summation;
    setup.materials = {{.name = "dust",
                        .eos = LinearEquationOfState{.reference_density = 1, .sound_speed = 1e-3},
                        .reference_density = 1}};
    const double mass[2] = {6e20, 2e20}, total = 8e20, axis = 1e6;  // of the relative orbit [m]
    const double apart = axis * (1 + eccentricity);                 // it starts at the far point
    const double mu = setup.gravity->constant * total;
    const double speed = std::sqrt(mu / axis * (1 - eccentricity) / (1 + eccentricity));
    const double period = 2 * M_PI * std::sqrt(axis * axis * axis / mu);
    ParticleSet particles("pair", 3);
    add_fields(particles, setup);
    if (comm.is_root()) {
        particles.resize(2);
        for (std::size_t i = 0; i < 2; ++i) {
            const double share = i == 0 ? -mass[1] / total : mass[0] / total;
            particles.data(field::id)[i] = i;
            particles.data(field::mass)[i] = mass[i];
            particles.data(field::smoothing_length)[i] = 1e4;
            particles.data(field::position, 0)[i] = share * apart;
            particles.data(field::velocity, 1)[i] = share * speed;
        }
    }
    Simulation run(comm, setup, std::move(particles));
    run.start();
    const double energy = -setup.gravity->constant * mass[0] * mass[1] / (2 * axis);
    Orbit orbit{};
    for (double before = 0, time_before = 0; run.time() < 1.5 * period;) {
        run.step();
        orbit.energy_drift = std::max(orbit.energy_drift, std::abs(run.totals().total_energy() / energy - 1));
        std::array<double, 6> relative{};  // position and velocity of one from the other
        for (std::size_t i = 0; i < run.particles().size(); ++i)
            for (int a = 0; a < 3; ++a) {
                const double sign = run.particles().data(field::id)[i] == 0 ? -1 : 1;
                relative[static_cast<std::size_t>(a)] += sign * run.particles().data(field::position, a)[i];
                relative[static_cast<std::size_t>(a + 3)] +=
                    sign * run.particles().data(field::velocity, a)[i];
            }
        const auto all = comm.all_gather(std::span<const double>(relative));
        for (std::size_t k = 0; k < 6; ++k) {
            relative[k] = 0;
            for (std::size_t r = 0; r < all.size() / 6; ++r) relative[k] += all[6 * r + k];
        }
        double outward = 0;
        for (std::size_t a = 0; a < 3; ++a) outward += relative[a] * relative[a + 3];
        if (before > 0 && outward <= 0) {  // back at the far point
            const double back = time_before + (run.time() - time_before) * before / (before - outward);
            orbit.period_error = std::abs(back / period - 1);
            orbit.distance_error = std::abs(std::hypot(relative[0], relative[1], relative[2]) / apart - 1);
            return orbit;
        }
        before = outward;
        time_before = run.time();
    }
    ADD_FAILURE() << "no orbit closed";
    return orbit;
}

TEST(TwoBodies, KeepToKeplersEllipse) {
    const Communicator comm = world();
    for (const double eccentricity : {0.1, 0.6}) {
        const Orbit coarse = run_orbit(comm, eccentricity, 0.2), fine = run_orbit(comm, eccentricity, 0.1);
        for (const Orbit& orbit : {coarse, fine})
            if (comm.is_root())
                fmt::print("| {} | {:.1e} | {:.1e} | {:.1e} |\n", eccentricity, orbit.energy_drift,
                           orbit.period_error, orbit.distance_error);
        // Leapfrog is of second order: a quarter at half the step, and no more than 1e-3 at 300 steps an
        // orbit.
        EXPECT_LT(coarse.energy_drift, 2e-3);
        EXPECT_LT(coarse.period_error, 2e-3);
        EXPECT_LT(coarse.distance_error, 2e-3);
        EXPECT_NEAR(coarse.energy_drift / fine.energy_drift, 4, 1);
        EXPECT_NEAR(coarse.period_error / fine.period_error, 4, 1);
    }
}

}  // namespace
}  // namespace talus::test
