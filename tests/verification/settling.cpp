#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "comm/exact_sum.hpp"
#include "src/setup/settle.hpp"
#include "tests/support/settling_scene.hpp"

/// Bodies that come to rest in their own gravity before a run ([settle]).
namespace talus::test {
namespace {

constexpr double radius = 50e3, density = 2700, sound_speed = 3000;

struct Start {
    double breathing;         ///< greatest kinetic energy of the motion along the radius [J]
    double central_pressure;  ///< mean over 0.4 of the radius, over the exact mean of the same particles [1]
    double shift;             ///< of the centre of mass at the start [m]
};

double squared(double x) { return x * x; }

/// Along and across the distance from the origin, which is the centre of mass.
struct Ball {
    const Simulation& run;

    Point vector(const Field<double>& field, std::size_t i) const {
        const ParticleSet& p = run.particles();
        return {p.data(field, 0)[i], p.data(field, 1)[i], p.data(field, 2)[i]};
    }
    /// Exact sums over the particles of what `add(i, sums)` gives.
    template <class Add>
    std::vector<double> sums(std::size_t count, Add&& add) const {
        std::vector<ExactSum> of_rank(count);
        for (std::size_t i = 0; i < run.particles().size(); ++i) add(i, of_rank);
        ExactSum::all_reduce(run.comm(), of_rank);
        std::vector<double> values;
        for (const ExactSum& sum : of_rank) values.push_back(sum.value());
        return values;
    }
    double radial_energy() const {
        return sums(1, [&](std::size_t i, std::vector<ExactSum>& sum) {
            const Point x = vector(field::position, i);
            const double along = dot(x, vector(field::velocity, i)) / std::max(norm(x), 1.0);
            sum[0].add(0.5 * run.particles().data(field::mass)[i] * along * along);
        })[0];
    }
    double central_pressure() const {
        const auto both = sums(2, [&](std::size_t i, std::vector<ExactSum>& sum) {
            const double r = norm(vector(field::position, i));
            if (r > 0.4 * radius) return;
            sum[0].add(run.particles().data(field::pressure)[i]);
            sum[1].add(2.0 / 3 * std::numbers::pi * newton_constant * squared(density) *
                       (squared(radius) - squared(r)));
        });
        return both[0] / both[1];
    }
    double shift() const {
        const auto arms = sums(3, [&](std::size_t i, std::vector<ExactSum>& sum) {
            const Point x = vector(field::position, i);
            for (std::size_t a = 0; a < 3; ++a) sum[a].add(x[a]);
        });
        return norm({arms[0], arms[1], arms[2]}) / static_cast<double>(run.total_particles());
    }
};

/// Two breathing periods of a ball that was settled or not.
Start begin(const Communicator& comm, int particles, const std::string& settle_table) {
    const SceneSetup scene = rock_ball(comm, particles, settle_table);
    ParticleSet made = make_particles(comm, scene);
    const auto settlings = settle(comm, scene, made, [] {});
    Simulation run(comm, scene.simulation, std::move(made));
    run.start();
    const Ball ball{run};
    Start result{.breathing = 0, .central_pressure = ball.central_pressure(), .shift = ball.shift()};
    while (run.time() < 4 * radius / sound_speed) {
        run.step();
        result.breathing = std::max(result.breathing, ball.radial_energy());
    }
    if (comm.is_root())
        fmt::print("| {} | {} | {:.2e} | {:.4f} | {:.1e} |\n", run.total_particles(),
                   settlings.empty() ? "no" : "yes", result.breathing, result.central_pressure, result.shift);
    return result;
}

TEST(Settling, ABallOfRockStaysQuietInTheEquilibriumOfItsGravity) {
    const Communicator comm = world();
    const Start let_go = begin(comm, 1000, ""), settled = begin(comm, 1000, "[settle]");
    // Let go, it falls by the strain of its own weight and rings: greatest speeds of order g R/c.
    const double fall =
        4.0 / 3 * std::numbers::pi * newton_constant * density * squared(radius) / sound_speed;
    const double mass = 4.0 / 3 * std::numbers::pi * density * radius * radius * radius;
    EXPECT_GT(let_go.breathing, 0.01 * 0.5 * mass * squared(fall));
    EXPECT_LT(std::abs(let_go.central_pressure), 1e-3);
    // The default imbalance of 0.1 leaves at most a hundredth of the energy.
    EXPECT_LT(settled.breathing, 0.01 * let_go.breathing);
    // P = 2/3 pi G rho^2 (R^2 - r^2) of an incompressible ball; the strain is 1e-4. The rest is the surface,
    // which is rough by a spacing, a tenth of the radius, and the softened gravity.
    EXPECT_NEAR(settled.central_pressure, 1, 0.03);
    EXPECT_LT(settled.shift, 1e-9 * radius);
    EXPECT_LT(let_go.shift, 1e-9 * radius);
}

}  // namespace
}  // namespace talus::test
