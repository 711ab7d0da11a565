#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "domain/depth_fields.hpp"
#include "src/depth_simulation.hpp"

/// The loops of the depth-integrated model on particles whose sums are known.
namespace talus::test {
namespace {

DepthSetup setup_on(Terrain terrain, int dimension) {
    DepthSetup setup;
    setup.box.dimension = dimension;
    setup.terrain = std::make_shared<const Terrain>(std::move(terrain));
    setup.settings.eta = dimension == 1 ? 1.6 : 1.3;
    setup.settings.largest_smoothing_length = 100;
    return setup;
}

/// Columns on a lattice of spacing 1, all of one volume.
ParticleSet lattice(const DepthSetup& setup, int count, double volume) {
    ParticleSet particles("columns", setup.box.dimension);
    DepthSimulation::add_fields(particles, setup);
    const int rows = setup.box.dimension == 2 ? count : 1;
    particles.resize(static_cast<std::size_t>(count * rows));
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const int k = static_cast<int>(i);
        particles.data(field::id)[i] = i;
        particles.data(field::position, 0)[i] = k % count;
        if (setup.box.dimension == 2) particles.data(field::position, 1)[i] = k / count;
        particles.data(field::volume)[i] = volume;
        particles.data(field::smoothing_length)[i] = setup.settings.eta;
    }
    return particles;
}

/// Index of the particle of an id.
std::size_t place_of(const ParticleSet& particles, std::uint64_t id) {
    const auto ids = particles.own(field::id);
    return static_cast<std::size_t>(std::find(ids.begin(), ids.end(), id) - ids.begin());
}

TEST(DepthPasses, EvenColumnsAreAsDeepAsTheyAre) {
    const Communicator alone(MPI_COMM_SELF);
    for (const int dimension : {1, 2}) {
        const DepthSetup setup = setup_on(Terrain(0, {0, 0}), dimension);
        DepthSimulation run(alone, setup, lattice(setup, 21, 0.7));
        run.start();
        const ParticleSet& particles = run.particles();
        const std::size_t middle = place_of(particles, dimension == 1 ? 10 : 10 * 21 + 10);
        EXPECT_NEAR(particles.data(field::depth)[middle], 0.7, 1e-14);
        EXPECT_NEAR(particles.data(field::smoothing_length)[middle], setup.settings.eta, 1e-13);
        EXPECT_NEAR(particles.data(field::acceleration, 0)[middle], 0, 1e-13);
        EXPECT_NEAR(particles.data(field::wave_speed)[middle], std::sqrt(9.81 * 0.7), 1e-13);
        EXPECT_LT(particles.data(field::acceleration, 0)[place_of(particles, 0)], -1);
    }
}

// Newton's method finds it from far off, too: a column that was alone is caught in a crowd.
TEST(DepthPasses, AColumnInACrowdFindsItsSmoothingLength) {
    const Communicator alone(MPI_COMM_SELF);
    for (const int dimension : {1, 2}) {
        const DepthSetup setup = setup_on(Terrain(0, {0, 0}), dimension);
        ParticleSet particles = lattice(setup, 9, 0.7);
        const std::uint64_t middle = dimension == 1 ? 4 : 4 * 9 + 4;
        particles.data(field::smoothing_length)[middle] = 60;
        DepthSimulation run(alone, setup, std::move(particles));
        run.start();
        EXPECT_NEAR(run.particles().data(field::smoothing_length)[place_of(run.particles(), middle)],
                    setup.settings.eta, 1e-13);
    }
}

// A block on a plane falls with g sin along it, less friction, whatever the plane's direction: in plan, its
// acceleration is that times the cosine. The depth along the normal is the height in plan times the cosine.
TEST(DepthPasses, ALoneColumnSlidesAsABlock) {
    const Communicator alone(MPI_COMM_SELF);
    const std::array<double, 2> slope{-0.6, 0.3};
    const double steepness2 = 0.6 * 0.6 + 0.3 * 0.3, cosine = 1 / std::sqrt(1 + steepness2);
    DepthSetup setup = setup_on(Terrain(5, slope), 2);
    setup.settings.form = depth::Form::bed_fitted;
    setup.settings.largest_smoothing_length = 2;
    setup.friction = depth::Coulomb{.friction = 0.2};
    DepthSimulation run(alone, setup, lattice(setup, 1, 0.5));
    run.start();
    for (int k = 0; k < 10; ++k) run.step();
    const double along = 9.81 * cosine * (std::sqrt(steepness2) - 0.2), in_plan = along * cosine;
    const double vx = run.particles().data(field::velocity, 0)[0],
                 vy = run.particles().data(field::velocity, 1)[0];
    EXPECT_NEAR(vx, in_plan * run.time() * 0.6 / std::sqrt(steepness2), 1e-12 * vx);
    EXPECT_NEAR(vy, -in_plan * run.time() * 0.3 / std::sqrt(steepness2), 1e-12 * vx);
    const DepthTotals totals = run.totals();
    EXPECT_NEAR(totals.greatest_speed, along * run.time(), 1e-12 * totals.greatest_speed);
}

// On a curved bed without friction a lone column keeps its energy: here a bowl of circles, radius 50 m.
TEST(DepthPasses, ALoneColumnKeepsItsEnergyInABowl) {
    const Communicator alone(MPI_COMM_SELF);
    TerrainGrid grid{{-40, -40}, {0.5, 0.5}, 161, 161, {}};
    for (std::size_t row = 0; row < grid.rows; ++row)
        for (std::size_t column = 0; column < grid.columns; ++column) {
            const double x = -40 + 0.5 * static_cast<double>(column),
                         y = -40 + 0.5 * static_cast<double>(row);
            grid.elevations.push_back(x * x + y * y < 2400 ? -std::sqrt(2500 - x * x - y * y) : -10);
        }
    DepthSetup setup = setup_on(Terrain(std::move(grid)), 2);
    setup.settings.form = depth::Form::bed_fitted;
    setup.settings.largest_smoothing_length = 0.5;
    setup.settings.courant = 0.2;
    ParticleSet block = lattice(setup, 1, 1e-4);
    block.data(field::position, 0)[0] = 20;
    block.data(field::velocity, 1)[0] = 5;
    DepthSimulation run(alone, setup, std::move(block));
    run.start();
    const auto energy = [&] { return run.totals().kinetic_energy + run.totals().potential_energy; };
    const double first = energy(), height = run.totals().potential_energy + 1e-4 * 1000 * 9.81 * 50;
    double greatest = 0;
    while (run.time() < 15) {
        run.step();
        greatest = std::max(greatest, std::abs(energy() - first));
    }
    EXPECT_LT(greatest, 2e-3 * height);
}

}  // namespace
}  // namespace talus::test
