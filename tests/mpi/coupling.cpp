#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "domain/random.hpp"
#include "io/agree.hpp"
#include "physics/dem/vectors.hpp"
#include "tests/support/by_id.hpp"
#include "tests/support/coupled_run.hpp"
#include "tests/support/gathered.hpp"
#include "tests/support/mixture.hpp"

namespace talus::test {
namespace {

namespace of = coupling_field;

/// Fractions and reactions of a fluid with grains in and around it, in order of ids.
std::vector<std::vector<double>> outcome(MPI_Comm ranks, PartitionMethod method, Boundary boundary) {
    const RandomStream random{.seed = 4};
    Box box;
    box.upper = {4, 4, 3};
    box.boundary = {boundary, boundary, Boundary::open};
    std::vector<PlacedSphere> spheres;
    for (std::size_t k = 0; k < 400; ++k)
        spheres.push_back({{4 * random.uniform(k, 0), 4 * random.uniform(k, 1), 4 * random.uniform(k, 2)},
                           0.02 + 0.1 * random.uniform(k, 3)});
    MixtureSample sample({.box = box,
                          .spacing = 0.3,
                          .jitter = 0.3,
                          .method = method,
                          .spreading = {.radius = 0.9, .planes = {{{0, 0, 0}, {0, 0, 1}}}},
                          .ranks = ranks},
                         spheres);
    sample.find_fractions();
    std::vector<coupling::Gathered> around(sample.grains.size());
    coupling::gather(sample.mixture(), sample.spreading, of::shared_fraction, true, around);
    const dem::Vectors force(sample.grains, of::exchanged_force);
    for (std::size_t i = 0; i < around.size(); ++i)
        force.put(i, around[i].velocity + around[i].crowding * around[i].vorticity);
    sample.refresh_grains({&of::exchanged_force});
    coupling::spread_force(sample.mixture(), sample.spreading);
    const ById fluid(sample.comm, sample.fluid), grains(sample.comm, sample.grains);
    std::vector<std::vector<double>> values;
    const ParticleSet &wet = sample.fluid, &solid = sample.grains;
    for (const Field<double>* field : {&of::solid_fraction, &of::shared_fraction})
        values.push_back(fluid(wet.own(*field)));
    for (int axis = 0; axis < 3; ++axis) {
        values.push_back(fluid(wet.own(of::grain_acceleration, axis)));
        values.push_back(grains(solid.own(of::exchanged_force, axis)));
    }
    values.push_back(grains(solid.own(of::kernel_sum)));
    return values;
}

// What fluid and grains exchange has the bits of one rank, whichever rank owns which part of either.
TEST(CouplingSameBits, AsOnOneRank) {
    for (const Boundary boundary : {Boundary::open, Boundary::periodic}) {
        const auto alone = outcome(MPI_COMM_SELF, PartitionMethod::slabs, boundary);
        for (const PartitionMethod method : {PartitionMethod::bisection, PartitionMethod::scrambled})
            EXPECT_TRUE(outcome(MPI_COMM_WORLD, method, boundary) == alone);
    }
}

/// A column of beads that falls apart in a shallow bath.
CoupledScene bath(const Communicator& comm, PartitionMethod method) {
    CoupledScene scene = coupled_scene(
        comm, std::filesystem::path(TALUS_SOURCE_DIR) / "runs" / "still_bed",
        {"body[0].upper=[0.024,0.024,0.018]", "body[0].surface=0.018", "grains[0].upper=[0.012,0.024,0.012]",
         "grains[0].held=false", "coupling.virtual_mass=0.5", "coupling.lift=both", "coupling.torque=true",
         "coupling.basset=true", "run.rebalance_interval=2"});
    scene.water.simulation.partition = method;
    return scene;
}

struct Outcome {
    GatheredState water, grains;
    bool operator==(const Outcome&) const = default;
};

Outcome outcome_of(const Communicator& comm, const CoupledSimulation& simulation) {
    return {gather_state(comm, simulation.water().particles()),
            gather_state(comm, simulation.grains().grains())};
}

constexpr int steps = 12;

Outcome run_bath(const Communicator& comm, PartitionMethod method) {
    const CoupledScene scene = bath(comm, method);
    CoupledSimulation simulation(comm, scene.simulation(), make_water(comm, scene.water),
                                 make_grains(comm, scene.grains));
    simulation.start();
    for (int k = 0; k < steps; ++k) simulation.step();
    simulation.grains().save();
    return outcome_of(comm, simulation);
}

// A whole run of both sets.
TEST(CoupledRunSameBits, OnAnyRanks) {
    const Communicator alone(MPI_COMM_SELF), world(MPI_COMM_WORLD);
    const Outcome expected = run_bath(alone, PartitionMethod::slabs);
    EXPECT_GT(expected.grains.ids.size(), 500u);
    for (const PartitionMethod method : {PartitionMethod::cheapest, PartitionMethod::scrambled})
        EXPECT_TRUE(run_bath(world, method) == expected);
}

// Stopped after five steps, and gone on with by other ranks.
TEST(CoupledRunSameBits, AfterInterruption) {
    const Communicator alone(MPI_COMM_SELF), world(MPI_COMM_WORLD);
    const Outcome expected = run_bath(alone, PartitionMethod::slabs);
    const CoupledScene first_scene = bath(world, PartitionMethod::scrambled);
    CoupledSimulation first(world, first_scene.simulation(), make_water(world, first_scene.water),
                            make_grains(world, first_scene.grains));
    first.start();
    for (int k = 0; k < 5; ++k) first.step();
    const ParticleSet contacts = first.grains().save();
    const Outcome saved = outcome_of(world, first);
    const GatheredState saved_contacts = gather_state(world, contacts);
    std::map<std::string, double> numbers;
    first.save_numbers(numbers);
    const CoupledScene scene = bath(world, PartitionMethod::bisection);
    // Each rank takes an equal share in order of id, as from a checkpoint.
    const auto share = [&](const GatheredState& state) {
        return [&, total = state.ids.size()](std::size_t k) {
            return k * static_cast<std::size_t>(world.size()) / total ==
                   static_cast<std::size_t>(world.rank());
        };
    };
    ParticleSet water = empty_water(scene.water.simulation), grains = empty_grains(scene.grains.simulation),
                remembered = dem::empty_contacts(3, GrainSimulation::history_fields(scene.grains.simulation));
    fill(water, saved.water, share(saved.water));
    fill(grains, saved.grains, share(saved.grains));
    fill(remembered, saved_contacts, share(saved_contacts));
    CoupledSimulation second(world, scene.simulation(), std::move(water), std::move(grains));
    second.resume(first.water().time(), first.water().time_step(), first.water().step_count(), numbers,
                  remembered);
    for (int k = 5; k < steps; ++k) second.step();
    second.grains().save();
    EXPECT_TRUE(outcome_of(world, second) == expected);
}

/// What a run says if one velocity is spoilt from the start, of a grain or of water.
std::string said_of_nan(bool of_grain, std::uint64_t id) {
    const Communicator world(MPI_COMM_WORLD);
    const CoupledScene scene = bath(world, PartitionMethod::cheapest);
    ParticleSet water = make_water(world, scene.water), grains = make_grains(world, scene.grains);
    ParticleSet& particles = of_grain ? grains : water;
    const auto ids = std::as_const(particles).own(field::id);
    if (const auto found = std::find(ids.begin(), ids.end(), id); found != ids.end())
        particles.data(field::velocity)[found - ids.begin()] = std::numeric_limits<double>::quiet_NaN();
    try {
        CoupledSimulation simulation(world, scene.simulation(), std::move(water), std::move(grains));
        simulation.start();
        simulation.step();
    } catch (const AgreedError& failure) {
        EXPECT_EQ(failure.exit_code, 1);
        return failure.what();
    }
    return "nothing";
}

// On all ranks, with what it is of.
TEST(CoupledFaults, NanIsNamed) {
    const std::string of_grain = said_of_nan(true, 9), of_water = said_of_nan(false, 9);
    EXPECT_NE(of_grain.find("grain 9"), std::string::npos) << of_grain;
    EXPECT_NE(of_water.find("is not finite"), std::string::npos) << of_water;
}

}  // namespace
}  // namespace talus::test
