#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/grain_collision.hpp"
#include "tests/support/grain_scene.hpp"

/// Of which order in the time step the tangential history is, and that it does not drift.
namespace talus::test {
namespace {

using dem::Vector3;
constexpr double pi = std::numbers::pi;

/// Tangential displacement that friction has stored after some periods of a fine grain that is moved to and
/// fro along a line oblique to the surface of a large one, 20 times its size, without spin or slip. What is
/// done on the way there is undone on the way back: the exact answer is zero. `lag`: of velocities behind
/// positions, in steps.
double stored_displacement(double lag, int steps_of_a_period, int periods) {
    const double fine = 1e-3, large = 20e-3, omega = 2 * pi, dt = 1.0 / steps_of_a_period;
    const double along = 0.05 * fine, into = 0.01 * fine;
    dem::WithFriction<dem::LinearSpring<double>> law{{1e3, 1e3, 0, 0, 0}, {1e12}, {}, {}, {}};
    std::array<double, 3> history{};
    for (int n = 1; n <= periods * steps_of_a_period; ++n) {
        const double place = std::sin(omega * n * dt), speed = omega * std::cos(omega * (n - lag) * dt);
        const Vector3<> separation{along * place, 0, large + 0.98 * fine + into * place};
        const dem::Grain<double> moved{{along * speed, 0, into * speed}, {}, fine, 1e-5};
        const dem::Grain<double> held{{}, {}, large, 1};
        law(dem::grain_kinematics(separation, norm(separation), moved, held, dt), history);
    }
    return std::sqrt(history[0] * history[0] + history[1] * history[1] + history[2] * history[2]);
}

// D. Vyas et al., arXiv 2410.14798 (2024): fine grains between large ones stick where codes combine
// velocities of the middle of the step with positions of its end. With v_n, v_t along the normal and across
// it and D the distance of the centres the normal turns by v_t dt/(2 D) in between, so that each step stores
// -v_n v_t dt^2/(2 D) too much: pi omega dt A B/(2 D) a period for amplitudes A and B, growing without end.
// Velocities of the same time store nothing.
TEST(HistoryOrder, FineGrainOnALargeOneStoresNoFalseDisplacement) {
    constexpr int steps = 200, periods = 50;
    const double trap = periods * pi * (2 * pi / steps) * 0.05e-3 * 0.01e-3 / (2 * 20.98e-3);
    EXPECT_NEAR(stored_displacement(0.5, steps, periods) / trap, 1, 0.02) << "the test sees no trap";
    EXPECT_LT(stored_displacement(0, steps, periods), 1e-3 * trap);
}

// A grain that rests on a floor and sticks is an oscillator of its slip, omega^2 = 7/2 k_t/m, k_t = 8 G* a.
// Displacements advance by the slip of the end of the step, dt/2 times the slip more than what the grain has
// gone: damping of ratio omega dt/4 without any dashpot. The history is of first order.
TEST(HistoryOrder, TangentialHistoryDampsInFirstOrderOfTheStep) {
    const Communicator comm(MPI_COMM_SELF);
    const double radius = 5e-3, density = 2500, g = 9.81, speed = 0.002;
    const dem::GrainMaterial soft{
        .name = "soft", .density = density, .youngs_modulus = 1e7, .poisson_ratio = 0.3, .friction = 0.8};
    const double m = mass_of({{}, {}, {}, radius, density}), modulus = 1e7 / (2 * 0.91),
                 shear_modulus = 1e7 / 2.6 / (2 * 1.7);
    const double depth = std::pow(0.75 * m * g / (modulus * std::sqrt(radius)), 2.0 / 3);
    const double omega = std::sqrt(3.5 * 8 * shear_modulus * std::sqrt(radius * depth) / m);
    for (const double dt : {2e-5, 1e-5}) {
        GrainSetup setup = grain_setup({soft}, radius, dt);
        setup.gravity = {0, 0, -g};
        setup.walls.push_back({"floor", 0, dem::PlaneShape{{}, {0, 0, 1}}, {}});
        GrainSimulation run(comm, setup,
                            grain_set(comm, {{{0, 0, radius - depth}, {speed, 0, 0}, {}, radius, density}}));
        run.start();
        const double period = 2 * pi / omega;
        double greatest = 0;
        while (run.time() < 10.5 * period) {
            run.step();
            const GrainState s = state_of(run, 0);
            if (run.time() > 9.75 * period)  // the swing about ten periods
                greatest = std::max(greatest, s.velocity.x - radius * s.angular_velocity.y);
        }
        const double rate = -std::log(greatest / speed) / (10 * period);
        EXPECT_NEAR(rate / (omega * omega * dt / 4), 1, 0.05) << dt;
    }
}

}  // namespace
}  // namespace talus::test
