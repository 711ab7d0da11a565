#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "domain/grain_fields.hpp"
#include "src/flow/contact_set.hpp"
#include "src/flow/region_statistics.hpp"
#include "tests/support/grain_scene.hpp"

/// What is said of grains and their contacts: stress, loads on walls, contacts to be written.
namespace talus::test {
namespace {

constexpr double radius = 0.01, along_x = 2e-5, along_y = 3e-5, along_z = 5e-5;  // overlaps
constexpr int nx = 6, ny = 5, nz = 7;

const dem::GrainMaterial rubber{
    .name = "rubber", .density = 1000, .youngs_modulus = 1e7, .poisson_ratio = 0.3, .friction = 0.5};

/// Force of two such spheres, H. Hertz, J. reine angew. Math. 92 (1882) 156.
double hertz(double overlap, double effective_radius) {
    const double modulus = rubber.youngs_modulus / (2 * (1 - rubber.poisson_ratio * rubber.poisson_ratio));
    return 4.0 / 3.0 * modulus * std::sqrt(effective_radius) * std::pow(overlap, 1.5);
}

/// A cubic lattice, periodic along x and y, between two planes that press as hard as the grains on each
/// other.
struct Lattice {
    double length_x = nx * (2 * radius - along_x), length_y = ny * (2 * radius - along_y);
    double at_wall = along_z * std::cbrt(0.5);  // R* = R there, R/2 between grains
    double lowest = radius - at_wall, spacing = 2 * radius - along_z;

    GrainSetup setup() const {
        GrainSetup made = grain_setup({rubber}, radius, 1e-6);
        made.box = {
            3, {0, 0, 0}, {length_x, length_y, 0}, {Boundary::periodic, Boundary::periodic, Boundary::open}};
        const double top = 2 * lowest + (nz - 1) * spacing;
        made.walls = {{"floor", 0, dem::PlaneShape{{}, {0, 0, 1}}, {}},
                      {"lid", 0, dem::PlaneShape{{0, 0, top}, {0, 0, -1}}, {}}};
        return made;
    }
    std::vector<GrainState> grains() const {
        std::vector<GrainState> made;
        for (int k = 0; k < nx * ny * nz; ++k)
            made.push_back({{(k % nx) * (2 * radius - along_x), (k / nx % ny) * (2 * radius - along_y),
                             lowest + (k / nx / ny) * spacing},
                            {},
                            {},
                            radius,
                            1000});
        return made;
    }
};

// Forces and areas are known to rounding; the differences of places near the box's length are good to 1e-14
// of it, 1e-11 of an overlap.
TEST(GrainStress, OfAPressedLatticeIsForceOverArea) {
    const Communicator world(MPI_COMM_WORLD);
    const Lattice lattice;
    GrainSimulation run(world, lattice.setup(), grain_set(world, lattice.grains()));
    run.start();
    // The outer contacts lie in the middle of their overlap: from one to the other force is borne.
    const double foot = -0.5 * lattice.at_wall, top = 2 * lattice.lowest + (nz - 1) * lattice.spacing - foot;
    const WatchedRegion all{"all", BoxShape{{0, 0, foot}, {lattice.length_x, lattice.length_y, top}}};
    // Three layers in the middle, bounded by the contacts above and below.
    const double low = lattice.lowest + 1.5 * lattice.spacing;
    const WatchedRegion middle{
        "middle", BoxShape{{0, 0, low}, {lattice.length_x, lattice.length_y, low + 3 * lattice.spacing}}};
    const std::vector<WatchedRegion> regions{all, middle};
    const auto states =
        region_states(world, run.grains(), run.setup().box, run.clumps(), 1, regions, run.loaded_contacts());
    EXPECT_EQ(states[0].count, nx * ny * nz);
    EXPECT_EQ(states[1].count, nx * ny * 3U);
    const double columns = nx * ny;
    const double zz = columns * hertz(along_z, radius / 2) / (lattice.length_x * lattice.length_y);
    EXPECT_NEAR(run.totals().wall_forces[1][2], columns * hertz(along_z, radius / 2), 1e-10 * columns);
    for (const RegionState& state : states) {
        const double height = &state == &states[0] ? top - foot : 3 * lattice.spacing;
        const double layers = &state == &states[0] ? nz : 3;
        const double xx = ny * layers * hertz(along_x, radius / 2) / (lattice.length_y * height);
        const double yy = nx * layers * hertz(along_y, radius / 2) / (lattice.length_x * height);
        EXPECT_NEAR(state.stress[0], xx, 1e-9 * xx);
        EXPECT_NEAR(state.stress[1], yy, 1e-9 * yy);
        EXPECT_NEAR(state.stress[2], zz, 1e-9 * zz);
        for (const std::size_t shear : {3U, 4U, 5U}) EXPECT_NEAR(state.stress[shear], 0, 1e-9 * xx);
    }
}

// Grains that do not touch bear rho v'v', whatever velocity they have in common: to rounding of its square.
TEST(GrainStress, OfAGasIsItsFluxOfMomentum) {
    const Communicator world(MPI_COMM_WORLD);
    std::vector<GrainState> grains;
    for (int k = 0; k < 64; ++k) {
        const double sign = k % 2 == 0 ? 1 : -1;
        grains.push_back({{0.03 * (k % 4), 0.03 * (k / 4 % 4), 0.03 * (k / 16)},
                          {3 + 0.2 * sign, -1, 0.1 * sign},
                          {},
                          radius,
                          1000});
    }
    GrainSimulation run(world, grain_setup({rubber}, radius, 1e-6), grain_set(world, grains));
    run.start();
    const WatchedRegion region{"gas", BoxShape{{-0.01, -0.01, -0.01}, {0.11, 0.11, 0.11}}};
    const auto state = region_states(world, run.grains(), run.setup().box, run.clumps(), 1, {&region, 1},
                                     run.loaded_contacts())[0];
    const double bulk = state.mass / (0.12 * 0.12 * 0.12);
    EXPECT_NEAR(state.mass, 64 * mass_of(grains[0]), 1e-14 * state.mass);
    EXPECT_NEAR(state.solid_fraction, bulk / 1000, 1e-14);
    EXPECT_NEAR(state.velocity[0], 3, 1e-14);
    EXPECT_NEAR(state.stress[0], bulk * 0.04, 1e-12 * bulk);
    EXPECT_NEAR(state.stress[1], 0, 1e-12 * bulk);
    EXPECT_NEAR(state.stress[2], bulk * 0.01, 1e-12 * bulk);
    EXPECT_NEAR(state.stress[5], bulk * 0.02, 1e-12 * bulk);
}

TEST(WallLoads, TorqueIsAboutTheCentreOfMotion) {
    const Communicator world(MPI_COMM_WORLD);
    GrainSetup setup = grain_setup({rubber}, radius, 1e-6);
    dem::Wall table{"table", 0, dem::PlaneShape{{}, {0, 0, 1}}, {}};
    table.motion.centre = {0.1, -0.2, 0};
    setup.walls.push_back(table);
    const GrainState grain{{0.3, 0.5, radius - along_z}, {}, {}, radius, 1000};
    GrainSimulation run(world, setup, grain_set(world, {grain}));
    run.start();
    const GrainTotals totals = run.totals();
    const double force = hertz(along_z, radius);
    EXPECT_NEAR(totals.wall_forces[0][2], -force, 1e-10 * force);
    EXPECT_NEAR(totals.wall_torques[0][0], -0.7 * force, 1e-10 * force);
    EXPECT_NEAR(totals.wall_torques[0][1], 0.2 * force, 1e-10 * force);
    EXPECT_EQ(totals.wall_torques[0][2], 0);
}

TEST(ContactSet, HoldsEachContactOnceWithItsForce) {
    const Communicator world(MPI_COMM_WORLD);
    const Lattice lattice;
    GrainSimulation run(world, lattice.setup(), grain_set(world, lattice.grains()));
    run.start();
    run.save();
    const ParticleSet contacts = contact_set(run.loaded_contacts(), run.grains());
    const auto total = world.all_sum(static_cast<std::uint64_t>(contacts.size()));
    EXPECT_EQ(total, static_cast<std::uint64_t>(nx * ny * (2 * nz + nz - 1 + 2)));
    for (std::size_t k = 0; k < contacts.size(); ++k) {
        double along = 0;
        for (int axis = 0; axis < 3; ++axis)
            along += contacts.own(field::normal, axis)[k] * contacts.own(field::contact_force, axis)[k];
        const bool at_wall = dem::is_wall_key(contacts.own(field::second_id)[k]);
        const double expected = hertz(contacts.own(field::overlap)[k], at_wall ? radius : radius / 2);
        EXPECT_NEAR(along, expected, 1e-10 * expected);
    }
}

}  // namespace
}  // namespace talus::test
