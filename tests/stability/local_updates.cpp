#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "physics/coupling/exchange.hpp"
#include "physics/depth/basal_friction.hpp"
#include "physics/gravity/tree.hpp"
#include "physics/soil/hencky.hpp"
#include "physics/solid/fracture.hpp"
#include "physics/solid/stress_update.hpp"
#include "tests/support/shared_cases.hpp"
#include "tests/support/solid_materials.hpp"
#include "tests/support/stability_row.hpp"

/// Steps of one grain, column or piece of matter, where the plain update fails and what the program does
/// instead: each fails beside what does not.
namespace talus::test {
namespace {

constexpr std::array shares{0.5, 0.95, 1.05, 1.5};

/// A row for a threshold that a plain update has, and one for ours at the same knob.
void print_both(StabilityRow row, const std::string& plain, double plain_found, bool plain_stable,
                const std::string& ours, double found) {
    if (!is_root()) return;
    row.scene = plain;
    row.found = plain_found;
    row.stable = plain_stable;
    print(row);
    row.scene = ours;
    row.found = found;
    row.stable = true;
    row.threshold = INFINITY;
    print(row);
}

/// Fluid at rest around a grain, whose volume is `crowding` for each mass of it [m3/kg].
coupling::Gathered fluid_at_rest(double density, double crowding) {
    return {.velocity = {},
            .vorticity = {},
            .force_density = {},
            .acceleration = {},
            .reaction = {},
            .solid_fraction = 0,
            .density = density,
            .crowding = crowding};
}

/// Slip of a grain and of the fluid around it after one exchange by Stokes' drag, over that before.
double slip_left(double rate_times_step, double mass_ratio) {
    constexpr double radius = 1e-4, viscosity = 1e-3, fluid_density = 1000, speed = 1e-6;
    const double volume = 4.0 / 3 * std::numbers::pi * std::pow(radius, 3),
                 fluid_mass = fluid_density * volume, mass = fluid_mass / mass_ratio,
                 drag = 6 * std::numbers::pi * viscosity * radius,
                 step = rate_times_step / (drag * (1 / mass + 1 / fluid_mass));
    const coupling::Gathered around = fluid_at_rest(fluid_density, volume / fluid_mass);
    const coupling::MovingGrain grain{radius, mass, false, {speed, 0, 0}, {}, {}};
    const double force =
        mean_force({.drag = coupling::Stokes{}, .viscosity = viscosity}, grain, around, 1, step).x;
    return 1 + force * step * (1 / mass + 1 / fluid_mass) / speed;
}

// Explicit drag leaves 1 - z of the slip, z = dt beta (1/m + 1/M): it grows beyond z = 2, dt = 2 t_s/(1 +
// m/M). mean_force() leaves exp(-z).
TEST(Drag, ExplicitStepsGrowBeyondTwoRelaxationTimes) {
    for (const double mass_ratio : {0.1, 10.0})
        for (const double share : shares) {
            const double z = 2 * share, plain = std::pow(std::abs(1 - z), 20),
                         found = slip_left(z, mass_ratio);
            EXPECT_EQ(plain < 1, share < 1);
            EXPECT_NEAR(found, std::exp(-z), 1e-12);
            const std::string masses = fmt::format(", fluid {} times as heavy", mass_ratio);
            print_both({"drag", {}, "dt/relaxation time", z, 2, "slip left after 20 steps", 0, true},
                       "explicit" + masses, plain, plain < 1, "as solved" + masses, std::pow(found, 20));
        }
}

// The force -C rho_f V a of the acceleration a of the step before: each step changes the error of a by
// -C rho_f/rho_s, however short it is. With it on the left-hand side a = F/(m + C rho_f V) at once.
TEST(VirtualMass, AsAForceItGrowsForLightSpheres) {
    constexpr double radius = 1e-3, force = 1;
    const double volume = 4.0 / 3 * std::numbers::pi * std::pow(radius, 3), fluid_mass = 1000 * volume;
    for (const double share : shares) {
        const double mass = 0.5 * fluid_mass / share, exact = force / (mass + 0.5 * fluid_mass);
        double lagged = 0;
        for (int step = 0; step < 40; ++step) lagged = (force - 0.5 * fluid_mass * lagged) / mass;
        const coupling::Gathered around = fluid_at_rest(1000, 0);
        const coupling::MovingGrain grain{radius, mass, false, {}, {}, {force / mass, 0, 0}};
        const double of_fluid = mean_force({.virtual_mass = 0.5}, grain, around, 1, 1e-3).x,
                     found = std::abs((force + of_fluid) / mass / exact - 1),
                     plain = std::abs(lagged / exact - 1);
        EXPECT_EQ(plain < 1, share < 1) << share;
        EXPECT_LT(found, 1e-12);
        print_both({"virtual mass", {}, "C rho_f/rho_s", share, 1, "error after 40 steps", 0, true},
                   "of the step before", plain, plain < 1, "as solved", std::max(found, 1e-16));
    }
}

// mu g cos(theta) dt beyond the speed turns a flow round that friction should stop.
TEST(BedFriction, ExplicitStepsTurnFlowsRound) {
    constexpr double friction = 0.5, gravity = 9.81, depth = 2, density = 2000, speed = 0.3;
    const depth::Column column{
        .depth = depth, .density = density, .normal_stress = density * gravity * depth};
    for (const double share : shares) {
        const double step = share * speed / (friction * gravity),
                     plain = (speed - step * friction * gravity) / speed,
                     found = depth::Coulomb{.friction = friction}.speed_after(speed, step, column) / speed;
        EXPECT_EQ(plain > 0, share < 1);
        EXPECT_NEAR(found, std::max(plain, 0.0), 1e-12);
        EXPECT_EQ(found == 0, share > 1);
        print_both({"friction of the bed", {}, "mu g dt/speed", share, 1, "speed left", 0, true}, "explicit",
                   plain, plain > 0, "implicit", found);
    }
}

// Elastic simple shear by g: Jaumann's rate turns the stress back beyond pi, G sin(g). Hencky's strain gives
// 4 G asinh(g/2)/sqrt(4 + g^2).
TEST(LargeShear, JaumannsRateTurnsTheStressRound) {
    const soil::Elasticity elastic{.youngs_modulus = 2.6, .poisson_ratio = 0.3};
    constexpr int steps = 4000;
    for (const double share : shares) {
        const double shear = share * std::numbers::pi;
        std::array<double, 3> jaumann{};
        soil::Tensor stress{};
        soil::History history;
        soil::Material material;
        material.elasticity = elastic;
        Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
        f(0, 1) = shear / steps;
        for (int k = 0; k < steps; ++k) {
            jaumann = advanced_stress<2>(jaumann, {0, 1, 0, 0}, elastic.shear_modulus(), shear / steps);
            stress = soil::hencky_stress(elastic, stress, f);
            ASSERT_TRUE(soil::relax(material, 1, 1.0 / steps, stress, history));
        }
        const double plain = jaumann[2] / elastic.shear_modulus(),
                     found = stress[3] / elastic.shear_modulus();
        EXPECT_NEAR(plain, std::sin(shear), 1e-3);
        EXPECT_EQ(plain > 0, share < 1);
        EXPECT_NEAR(found, 4 * std::asinh(shear / 2) / std::sqrt(4 + shear * shear), 1e-9);
        print_both({"large shear", {}, "shear", shear, std::numbers::pi, "shear stress/G", 0, true},
                   "Jaumann's rate", plain, plain > 0, "Hencky's strain", found);
    }
}

// Cold basalt that is stretched: by hand c^2 = (A + 2 B mu)/rho0 + (a + b) (A mu + B mu^2)/rho is negative
// below a density; the floor of the sound speed keeps the time step.
TEST(ColdTension, TheSquareOfTheSoundSpeedTurnsNegative) {
    const Tillotson eos = basalt();
    const auto by_hand = [&](double ratio) {
        const double mu = ratio - 1;
        return (eos.A + 2 * eos.B * mu + (eos.a + eos.b) * (eos.A * mu + eos.B * mu * mu) / ratio) /
               eos.reference_density;
    };
    double low = 0.3, high = 1;
    while (high - low > 1e-12) (by_hand((low + high) / 2) < 0 ? low : high) = (low + high) / 2;
    for (const double share : {0.8, 0.95, 1.05, 1.2}) {
        const double density = share * low * eos.reference_density, bulk = eos.A / eos.reference_density;
        const EosState state = eos.state(density, 0);
        EXPECT_NEAR(state.sound_speed_squared / bulk, by_hand(share * low) / bulk, 1e-9);
        EXPECT_EQ(state.sound_speed_squared > 0, share > 1);
        const double speed = sound_speed(eos, state);
        EXPECT_GE(speed * speed, eos.least_sound_speed_squared() * (1 - 1e-12));
        print_both({"cold tension", {}, "density over that at rest", share * low, low, "c2 rho0/A", 0, true},
                   "Tillotson", state.sound_speed_squared / bulk, state.sound_speed_squared > 0,
                   "with the floor", speed * speed / bulk);
    }
}

// Cracks make D^(1/3) grow at a constant rate. From D = 0 a step of more than the time to break takes the
// plain update beyond 1, and what is left of the stress, 1 - D of it, changes sign.
TEST(Damage, AStepLongerThanTheTimeToBreakReversesTheStress) {
    const CrackGrowth growth{.crack_speed = 2000, .young_modulus = 6e10, .crack_count_power = 1.0 / 3};
    const Flaws flaws{.threshold = 1e-3f, .exponent = 3, .count = 8};
    constexpr double strain = 5e-3, support = 2e-3;
    const double rate = damage_rate(growth, flaws, strain, support).rate;
    EXPECT_NEAR(rate, 2 * growth.crack_speed / support, 1e-9 * rate);  // all eight are open
    std::vector<float> threshold(1, flaws.threshold), exponent(1, flaws.exponent);
    std::vector<std::uint32_t> count(1, flaws.count);
    const std::vector<double> pressure(1, -growth.young_modulus * strain), deviator(1), radius(1, support);
    const std::vector<std::uint8_t> body(1);
    const FractureState state{{threshold, exponent, count}, pressure, {1, {deviator.data()}}, radius, 1};
    for (const double share : shares) {
        std::vector<double> damage(1);
        grow_damage(growth, state, share / rate, damage, body, 0);
        const double plain = 1 - share * share * share;
        EXPECT_EQ(plain > 0, share < 1);
        EXPECT_NEAR(1 - damage[0], std::max(plain, 0.0), 1e-9);
        print_both({"damage", {}, "dt/time to break", share, 1, "stress left", 0, true}, "plain", plain,
                   plain > 0, "limited", 1 - damage[0]);
    }
}

// J. K. Salmon, M. S. Warren, J. Comput. Phys. 111 (1994) 136, section 5: all but a thousandth of the mass of
// a cell in one corner, the rest in the opposite one, and a target just beyond that. With the cell's size
// over the distance of its centre of mass as the criterion it is taken together for theta > 1/sqrt(3),
// whatever error that makes. With the distance of what may be in it the cell is opened.
TEST(GravityOpening, SizeOverDistanceTakesLopsidedCellsTogether) {
    constexpr double light = 1e-3, beyond = 1 + 1e-3, threshold = 1 / (std::numbers::sqrt3 * beyond);
    const auto pull = [](double mass, double distance) { return mass / (3 * distance * distance); };
    const double exact = pull(1 - light, beyond) + pull(light, beyond - 1),
                 together = pull(1, beyond - light), error = std::abs(together / exact - 1);
    for (const double share : shares) {
        const double theta = share * threshold;
        const bool accepted = 1 / (std::numbers::sqrt3 * beyond) < theta;
        EXPECT_EQ(accepted, share > 1);
        const gravity::OpeningTest opening{.relative = false,
                                           .theta2 = theta * theta,
                                           .half_support = 1,
                                           .constant = 1,
                                           .accuracy = 1e-3,
                                           .order = 3};
        gravity::Node node{};
        node.moments.mass = 1;
        node.radius = std::numbers::sqrt3;
        const gravity::Target target{{{beyond, beyond, beyond}, {beyond, beyond, beyond}}, 1e-4, 1e-2};
        EXPECT_FALSE(opening.accepts(node, target)) << theta;
        print_both({"gravity of a lopsided cell", {}, "theta", theta, threshold, "relative error", 0, true},
                   "size over distance", accepted ? error : 0, !accepted, "radius over distance", 0);
    }
    EXPECT_GT(error, 0.9);
}

}  // namespace
}  // namespace talus::test
