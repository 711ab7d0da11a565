#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/support/coupled_run.hpp"
#include "tests/support/root_of.hpp"
#include "tests/support/sphere_release.hpp"

/// Water and grains against closed forms: what drag, buoyancy and the balance of both phases' momentum ask
/// for.
namespace talus::test {
namespace {

const std::filesystem::path runs = std::filesystem::path(TALUS_SOURCE_DIR) / "runs";

struct MeanVelocities {
    double water = 0, grains = 0;  ///< mean velocities [m/s]
};

MeanVelocities phases_of(const CoupledSimulation& simulation, std::size_t axis) {
    const WaterTotals w = simulation.water().totals();
    const GrainTotals g = simulation.grains().totals();
    return {w.momentum[axis] / w.mass, g.momentum[axis] / g.mass};
}

constexpr double gravity = 9.81, liquid = 1150, glass = 2500, viscosity = 8.9e-3, diameter = 1e-3;

/// Overrides for the scene of hindered settling with another share of liquid.
std::vector<std::string> at_fraction(double fraction, int beads_along, int water_along) {
    const double ball = std::numbers::pi / 6 * std::pow(diameter, 3),
                 mixture = fraction * liquid + (1 - fraction) * glass;
    const double spacing = std::cbrt(ball / (1 - fraction)), side = beads_along * spacing;
    return {fmt::format("box.upper=[{0:.17g},{0:.17g},{0:.17g}]", side),
            fmt::format("body[0].spacing={:.17g}", side / water_along),
            fmt::format("grains[0].spacing={:.17g}", spacing),
            fmt::format("water.gravity=[0,0,{:.17g}]", -gravity * (1 - mixture / liquid)),
            fmt::format("dem.gravity=[0,0,{:.17g}]", -gravity * (1 - mixture / glass))};
}

// Balance of weight less displaced liquid and the total force of Di Felice's law on a bead, as in the unit
// tests; both models share the pressure such that the slip is the same.
TEST(Coupling, HinderedSettling) {
    const Communicator world(MPI_COMM_WORLD);
    for (const auto& [fraction, model] : std::initializer_list<std::pair<double, const char*>>{
             {0.6, "A"}, {0.8, "A"}, {0.8, "B"}, {0.95, "A"}}) {
        std::vector<std::string> overrides = at_fraction(fraction, 8, 4);
        overrides.insert(overrides.end(), {fmt::format("coupling.model={}", model), "run.end_time=0.12"});
        const CoupledScene scene = coupled_scene(world, runs / "hindered_settling", overrides);
        MeanVelocities last;
        double imbalance = 0;
        run_coupled(world, scene, [&](const CoupledSimulation& s) {
            if (s.water().step_count() % 20 != 0) return;
            last = phases_of(s, 2);
            imbalance = std::max(imbalance, s.totals().imbalance);
        });
        const double weight = std::numbers::pi / 6 * std::pow(diameter, 3) * (glass - liquid) * gravity;
        const double slip = root_of(
            [&](double w) {
                return w * coupling::drag_coefficient(coupling::DiFelice{}, coupling::PressureModel::b,
                                                      {liquid, viscosity, fraction}, diameter, w) -
                       weight;
            },
            0, 1);
        EXPECT_NEAR((last.water - last.grains) / slip, 1, 0.005) << fraction << ' ' << model;
        EXPECT_LT(imbalance, 1e-13) << fraction << ' ' << model;
    }
}

// Ergun's pressure drop: the velocity at which it equals the drive.
TEST(Coupling, PackedBed) {
    const Communicator world(MPI_COMM_WORLD);
    for (const double drive : {2.0, 40.0}) {
        const CoupledScene scene = coupled_scene(
            world, runs / "packed_bed", {fmt::format("water.gravity=[{},0,0]", drive), "run.end_time=0.03"});
        double found = 0, fraction = 0;
        run_coupled(world, scene, [&](const CoupledSimulation& s) {
            if (s.water().step_count() % 20 != 0) return;
            found = phases_of(s, 0).water;
            fraction = 1 - s.totals().grain_volume / std::pow(s.setup().water.box.upper[0], 3);
        });
        const double superficial = root_of(
            [&](double u) {
                const double e = fraction;
                return 150 * viscosity * (1 - e) * (1 - e) * u / (e * e * e * diameter * diameter) +
                       1.75 * liquid * (1 - e) * u * u / (e * e * e * diameter) - liquid * drive;
            },
            0, 1);
        EXPECT_NEAR(fraction * found / superficial, 1, 0.005) << drive;
    }
}

// One bead far from others, that the liquid feels: the root of weight, buoyancy and Di Felice's drag.
TEST(Coupling, SettlingGrain) {
    const Communicator world(MPI_COMM_WORLD);
    const CoupledScene scene = coupled_scene(world, runs / "settling_grain", {"run.end_time=0.3"});
    double begin = 0, since = 0, mean = 0;
    run_coupled(world, scene, [&](const CoupledSimulation& s) {
        const double time = s.water().time(), height = s.totals().mean_place[2];
        if (time < 0.05) {  // three relaxation times
            begin = height;
            since = time;
        } else {
            mean = (begin - height) / (time - since);
        }
    });
    EXPECT_NEAR(mean, 0.0487297, 0.01 * 0.0487297);
}

// Beads far apart, let go in a liquid that does not feel them: the exact solution under Stokes drag, virtual
// mass and Basset's force, to the thousandth that the kernel is right to; found 5e-5, in steps of 1/38 of the
// relaxation time. Without Basset's force the velocity is off by up to 0.37 of the terminal one.
TEST(Coupling, BassetsForceOnBeadsLetGo) {
    const Communicator world(MPI_COMM_WORLD);
    std::vector<std::string> overrides = at_fraction(0.99, 4, 4);
    const double weight = gravity * (1 - liquid / glass);
    overrides.insert(overrides.end(),
                     {"water.gravity=[0,0,0]", fmt::format("dem.gravity=[0,0,{:.17g}]", -weight),
                      "water.greatest_speed=0.5", "coupling.drag=stokes", "coupling.feedback=false",
                      "coupling.virtual_mass=0.5", "coupling.basset=true", "run.end_time=0.06"});
    const CoupledScene scene = coupled_scene(world, runs / "hindered_settling", overrides);
    const SphereRelease sphere{
        .diameter = diameter, .viscosity = viscosity / liquid, .density_ratio = glass / liquid};
    const double terminal = -glass * weight * diameter * diameter / (18 * viscosity);
    double worst = 0;
    run_coupled(world, scene, [&](const CoupledSimulation& s) {
        if (s.water().step_count() % 10 != 9) return;
        worst =
            std::max(worst, std::abs(phases_of(s, 2).grains / terminal - sphere.velocity(s.water().time())));
    });
    EXPECT_LT(worst, 0.001);
}

// Beads that stand in water at rest: it bears the weight of the water that they displace, and comes to rest
// after it was put on a lattice.
TEST(Coupling, StillBed) {
    const Communicator world(MPI_COMM_WORLD);
    const CoupledScene scene = coupled_scene(world, runs / "still_bed", {"run.end_time=0.16"});
    double force = 0, early = 0, late = 0;
    std::uint64_t count = 0;
    run_coupled(world, scene, [&](const CoupledSimulation& s) {
        if (s.water().step_count() % 20 != 0) return;
        const double energy = s.water().totals().kinetic_energy;
        if (s.water().time() < 0.06) {
            early = std::max(early, energy);
            return;
        }
        force += s.totals().force[2];
        ++count;
        late = energy;
    });
    const double displaced = 1000 * gravity * 2048 * std::numbers::pi / 6 * std::pow(1.5e-3, 3);
    EXPECT_NEAR(force / static_cast<double>(count) / displaced, 1, 0.01);
    EXPECT_LT(late, 0.5 * early);
}

// Grains that have settled loosely, half of the depth of the water above them: they rest as they did dry, and
// bear the weight of the water that they displace. 3 %: the water rings by a tenth about that, for five
// periods.
TEST(Coupling, SettledBedStaysAtRest) {
    const Communicator world(MPI_COMM_WORLD);
    const CoupledScene scene = coupled_scene(
        world, runs / "dam_break_bed",
        {"body[0].upper=[0.036,0.024,0.03]", "body[0].surface=0.03", "body[1].upper=[0.06,0.024,0]",
         "body[2].upper=[0,0.024,0.06]", "body[3].lower=[0.036,0,0]", "body[3].upper=[0.06,0.024,0.06]",
         "grains[0].upper=[0.036,0.024,0.018]", "wall[3].point=[0.036,0,0]",
         "wall[3].motion.velocity=[0,0,0]", "water.greatest_speed=0.6", "run.end_time=0.06"});
    const double volume = 4.0 / 3 * std::numbers::pi * std::pow(1.5e-3, 3);
    double force = 0, count = 0, first = 0, last = 0, grains = 0;
    run_coupled(world, scene, [&](const CoupledSimulation& s) {
        const CouplingTotals totals = s.totals();
        grains = totals.grain_volume / volume;
        force += totals.force[2];
        count += 1;
        last = totals.mean_place[2];
        if (s.water().step_count() == 0) first = last;
        EXPECT_LT(s.grains().totals().greatest_speed, 0.05);  // 0.17 m/s: a fall through a grain's radius
    });
    EXPECT_GT(grains, 400);
    EXPECT_NEAR(force / count / (1000 * gravity * grains * volume), 1, 0.03);
    EXPECT_NEAR(last, first, 0.01 * 3e-3);
}

// A small column of water and grains falls apart between walls that slip. Its layers of water along the walls
// drift towards them; without cores in the walls the first is 0.04 spacings from the floor after 0.08 s, and
// does not stop. Cores of 0.9 spacings let none nearer to the face than sqrt(0.81 - 0.5) - 0.5 = 0.06
// spacings where none presses.
TEST(Coupling, DrainingColumnStaysWithinItsWalls) {
    const Communicator world(MPI_COMM_WORLD);
    const CoupledScene scene = coupled_scene(
        world, runs / "dam_break_bed",
        {"box.upper=[0.324,0.024,0.2]", "body[0].upper=[0.036,0.024,0.06]", "body[0].surface=0.06",
         "body[1].upper=[0.124,0.024,0]", "body[2].upper=[0,0.024,0.09]", "body[1].wall='free_slip'",
         "body[2].wall='free_slip'", "grains[0].upper=[0.036,0.024,0.025]", "wall[3].point=[0.036,0,0]",
         "settle.imbalance=1", "settle.lasting=1", "run.end_time=0.08"});
    const double spacing = 0.006;
    std::array<double, 2> least{spacing, spacing};
    run_coupled(world, scene, [&](const CoupledSimulation& s) {
        const WaterTotals totals = s.water().totals();
        least[0] = std::min(least[0], totals.least_place[0]);
        least[1] = std::min(least[1], totals.least_place[2]);
    });
    EXPECT_GT(least[0], 0.06 * spacing);
    EXPECT_GT(least[1], 0.06 * spacing);
}

}  // namespace
}  // namespace talus::test
