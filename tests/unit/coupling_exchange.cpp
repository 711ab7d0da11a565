#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "comm/exact_sum.hpp"
#include "domain/random.hpp"
#include "physics/coupling/exchange.hpp"
#include "physics/dem/vectors.hpp"
#include "tests/support/mixture.hpp"

namespace talus::test {
namespace {

namespace of = coupling_field;
using namespace coupling;

constexpr double grain_density = 2500;

double volume(double radius) { return 4.0 / 3 * std::numbers::pi * radius * radius * radius; }

std::vector<PlacedSphere> scattered(std::size_t count) {
    const RandomStream random{.seed = 8};
    std::vector<PlacedSphere> spheres;
    for (std::size_t k = 0; k < count; ++k)
        spheres.push_back({{0.005 + 0.03 * random.uniform(k, 0), 0.005 + 0.03 * random.uniform(k, 1),
                            0.005 + 0.03 * random.uniform(k, 2)},
                           k % 2 == 0 ? 3e-4 : 1e-3});
    return spheres;
}

/// Grains of two sizes with random velocities in a fluid with random velocities.
struct Crowd : MixtureSample {
    explicit Crowd(std::size_t count)
        : MixtureSample({.box = {.upper = {0.04, 0.04, 0.04}},
                         .spacing = 0.004,
                         .jitter = 0.2,
                         .spreading = {.radius = 0.01}},
                        scattered(count)) {
        const RandomStream random{.seed = 9};
        const dem::Vectors velocity(grains, field::velocity);
        for (std::size_t i = 0; i < grains.size(); ++i) {
            const std::uint64_t id = grains.data(field::id)[i];
            velocity.put(i,
                         {random.uniform(id, 5) - 0.2, random.uniform(id, 6), random.uniform(id, 7) - 0.9});
        }
        find_fractions();
    }
};

struct Totals {
    std::array<double, 3> momentum;
    double kinetic_energy;
};

Totals totals(const MixtureSample& sample) {
    std::array<ExactSum, 4> sums;
    const auto add = [&](double mass, const dem::Vector3<>& v) {
        sums[0].add(mass * v.x);
        sums[1].add(mass * v.y);
        sums[2].add(mass * v.z);
        sums[3].add(0.5 * mass * dot(v, v));
    };
    const dem::Vectors of_fluid(sample.fluid, field::predicted_velocity),
        of_grains(sample.grains, field::velocity);
    for (std::size_t a = 0; a < sample.fluid.size(); ++a) add(sample.fluid.data(field::mass)[a], of_fluid[a]);
    for (std::size_t i = 0; i < sample.grains.size(); ++i)
        add(grain_density * volume(sample.grains.data(field::radius)[i]), of_grains[i]);
    ExactSum::all_reduce(sample.comm, sums);
    return {{sums[0].value(), sums[1].value(), sums[2].value()}, sums[3].value()};
}

/// One exchange over a time step, nothing else acting.
void exchange(MixtureSample& sample, const ExchangeLaws& laws, double time_step) {
    std::vector<Gathered> around(sample.grains.size());
    gather(sample.mixture(), sample.spreading, of::shared_fraction, laws.needs_vorticity(), around);
    const dem::Vectors velocity(sample.grains, field::velocity), force(sample.grains, of::exchanged_force);
    for (std::size_t i = 0; i < sample.grains.size(); ++i) {
        const double radius = sample.grains.data(field::radius)[i], mass = grain_density * volume(radius);
        MovingGrain grain{radius, mass, false, velocity[i], {}, {}};
        if (laws.basset)  // set in motion just now
            grain.remembered = laws.basset->between(0, time_step).recent * (around[i].velocity - velocity[i]);
        const dem::Vector3<> f =
            mean_force(laws, grain, around[i], sample.grains.data(of::wet_share)[i], time_step);
        force.put(i, f);
        velocity.put(i, velocity[i] + (time_step / mass) * f);
    }
    sample.refresh_grains({&of::exchanged_force});
    spread_force(sample.mixture(), sample.spreading);
    const dem::Vectors fluid(sample.fluid, field::predicted_velocity),
        reaction(sample.fluid, of::grain_acceleration);
    for (std::size_t a = 0; a < sample.fluid.size(); ++a) fluid.put(a, fluid[a] + time_step * reaction[a]);
    sample.refresh_fluid({&field::predicted_velocity});
}

// What grains gain the fluid loses, to rounding; drag never adds energy, however stiff. Relaxation times of
// the grains are 0.03 to 0.3 s in water, of 1e-6 s and less where the fluid is a million times as viscous.
TEST(Exchange, KeepsMomentumAndNeverGainsEnergy) {
    for (const double viscosity : {1e-3, 1e3})
        for (const double time_step : {1e-4, 1.0, 1e4}) {
            Crowd sample(3000);
            const Totals before = totals(sample);
            double energy = before.kinetic_energy;
            for (int k = 0; k < 4; ++k) {
                exchange(sample, {.viscosity = viscosity}, time_step);
                const Totals after = totals(sample);
                for (std::size_t a = 0; a < 3; ++a)
                    EXPECT_NEAR(after.momentum[a] - before.momentum[a], 0,
                                1e-14 * std::abs(before.momentum[2]) * 100);
                EXPECT_LT(after.kinetic_energy, energy);
                energy = after.kinetic_energy;
            }
        }
}

// The same where grains are set in motion just now and Basset's force acts: with the change of the slip to
// come in what is solved, they take no more from the fluid than it has, either.
TEST(Exchange, HistoryTakesEnergyFromASuddenStart) {
    for (const double time_step : {1e-4, 1.0, 1e4}) {
        Crowd sample(3000);
        const Totals before = totals(sample);
        ExchangeLaws laws{.viscosity = 1e-3, .virtual_mass = 0};
        laws.basset.emplace(time_step, 10 * time_step);
        exchange(sample, laws, time_step);
        const Totals after = totals(sample);
        for (std::size_t a = 0; a < 3; ++a)
            EXPECT_NEAR(after.momentum[a] - before.momentum[a], 0, 1e-12 * std::abs(before.momentum[2]));
        EXPECT_LT(after.kinetic_energy, before.kinetic_energy) << time_step;
    }
}

// One grain so small that it follows the fluid at once: time steps of up to a million relaxation times bring
// it to the velocity of the fluid plus that of settling, without ringing.
TEST(Exchange, TinyGrainsFollowTheFluid) {
    constexpr double radius = 1e-6, viscosity = 1e-3, fluid_density = 1000, gravity = -9.81;
    const double mass = grain_density * volume(radius),
                 relaxation = mass / (6 * std::numbers::pi * viscosity * radius);
    const Gathered around{.velocity = {0.5, 0, 0},
                          .vorticity = {},
                          .force_density = {0, 0, -gravity * fluid_density},
                          .acceleration = {},
                          .reaction = {},
                          .solid_fraction = 0,
                          .density = fluid_density,
                          .crowding = 0};  // far more fluid than the grain could move
    const double settling =
        mass * gravity * (1 - fluid_density / grain_density) / (6 * std::numbers::pi * viscosity * radius);
    for (const double steps : {0.01, 1.0, 30.0, 1e6}) {
        const double time_step = steps * relaxation;
        MovingGrain grain{radius, mass, false, {0, 0, 1}, {}, {0, 0, gravity}};
        double last = 1 - settling;
        for (int k = 0; k < 4000 && last > 1e-12; ++k) {
            const dem::Vector3<> force =
                mean_force({.drag = Stokes{}, .viscosity = viscosity}, grain, around, 1, time_step);
            grain.velocity += time_step * (grain.other_acceleration + (1 / mass) * force);
            const double left = std::abs(grain.velocity.z - settling);
            EXPECT_LE(left, last + 1e-14);
            last = left;
        }
        EXPECT_NEAR(grain.velocity.x, 0.5, 1e-9);
        EXPECT_NEAR(grain.velocity.z, settling, 1e-12);
    }
}

// Grains at even spacing hold, together, the mass of fluid that there is.
TEST(Exchange, GrainsShareTheFluidsMass) {
    Crowd sample(3000);
    std::vector<Gathered> around(sample.grains.size());
    gather(sample.mixture(), sample.spreading, of::shared_fraction, false, around);
    // The fluid's demand: sum over grains of share times mass at hand is no more than the particle's mass.
    const dem::Vectors force(sample.grains, of::exchanged_force);
    for (std::size_t i = 0; i < sample.grains.size(); ++i)
        force.put(i, {volume(sample.grains.data(field::radius)[i]) / around[i].crowding, 0, 0});
    sample.refresh_grains({&of::exchanged_force});
    spread_force(sample.mixture(), sample.spreading);
    const dem::Vectors demand(sample.fluid, of::grain_acceleration);
    double mean = 0;
    std::size_t wetted = 0;
    for (std::size_t a = 0; a < sample.fluid.size(); ++a)
        if (demand[a].x != 0) {
            mean -= demand[a].x;
            ++wetted;
        }
    EXPECT_LT(mean / static_cast<double>(wetted), 1);
    EXPECT_GT(mean / static_cast<double>(wetted), 0.5);
}

// A light sphere in an inviscid fluid at rest: (m + m_f/2) dv/dt = (m_f - m) g upwards (H. Lamb,
// Hydrodynamics, art. 92).
TEST(Exchange, VirtualMassOfALightSphere) {
    constexpr double radius = 1e-3, gravity = 9.81;
    const double displaced = 1000 * volume(radius), mass = 0.1 * displaced;
    const Gathered around{.velocity = {},
                          .vorticity = {},
                          .force_density = {0, 0, 1000 * gravity},
                          .acceleration = {},
                          .reaction = {},
                          .solid_fraction = 0,
                          .density = 1000,
                          .crowding = 0};
    const MovingGrain grain{radius, mass, false, {}, {}, {0, 0, -gravity}};
    const dem::Vector3<> force = mean_force({.virtual_mass = 0.5}, grain, around, 1, 1e-3);
    EXPECT_NEAR(force.z / mass - gravity, (displaced - mass) * gravity / (mass + 0.5 * displaced), 1e-10);
}

// A ball that spins in a fluid that turns: omega - w/2 falls off as exp(-60 mu t/(rho d^2)), the torque over
// the ball's moment of inertia, in steps of any length.
TEST(Exchange, SpinFollowsTheFluid) {
    constexpr double radius = 5e-4, viscosity = 1e-3;
    const Gathered around{.velocity = {},
                          .vorticity = {0, 0, 8},
                          .force_density = {},
                          .acceleration = {},
                          .reaction = {},
                          .solid_fraction = 0,
                          .density = 1000,
                          .crowding = 0};
    const double mass = grain_density * volume(radius), time = 0.05;
    const double left = std::exp(-60 * viscosity * time / (grain_density * 4 * radius * radius));
    for (const int steps : {1, 10, 1000}) {
        MovingGrain grain{radius, mass, false, {}, {100, 0, -20}, {}};
        for (int k = 0; k < steps; ++k)
            grain.spin =
                relaxed_spin({.viscosity = viscosity, .torque = true}, grain, around, 1, time / steps);
        EXPECT_NEAR(grain.spin.x, 100 * left, 1e-10);
        EXPECT_NEAR(grain.spin.z, 4 - 24 * left, 1e-10);
    }
}

// The vorticity of a fluid that turns, found at grains anywhere in it.
TEST(Exchange, VorticityOfATurningFluid) {
    Crowd sample(50);
    const dem::Vectors velocity(sample.fluid, field::predicted_velocity),
        place(sample.fluid, field::position);
    for (std::size_t a = 0; a < sample.fluid.size(); ++a)
        velocity.put(a, cross(dem::Vector3<>{1, -2, 3}, place[a]));
    sample.refresh_fluid({&field::predicted_velocity});
    std::vector<Gathered> around(sample.grains.size());
    gather(sample.mixture(), sample.spreading, of::shared_fraction, true, around);
    for (const Gathered& found : around) EXPECT_LT(norm(found.vorticity - dem::Vector3<>{2, -4, 6}), 1e-9);
}

}  // namespace
}  // namespace talus::test
