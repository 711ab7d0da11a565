#include "src/setup/handed_grains.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "domain/grain_fields.hpp"
#include "io/checkpoint.hpp"
#include "random_particles.hpp"
#include "src/setup/grain_scene.hpp"
#include "src/setup/shrink_grains.hpp"
#include "tests/support/gathered.hpp"
#include "tests/support/grain_scene.hpp"

/// Grains of another run as the start of a scene, and grains that overlap at the start.
namespace talus::test {
namespace {

// Sums of some hundred products.
constexpr double rounding = 1e-13;

std::vector<GrainState> crowd() {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto vector = [&](double size) {
        return dem::Vector3<>{size * uniform(random), size * uniform(random), size * uniform(random)};
    };
    std::vector<GrainState> grains;
    for (int k = 0; k < 400; ++k)
        grains.push_back({dem::Vector3<>{4.0 * (k % 8), 4.0 * (k / 8 % 8), 4.0 * (k / 64)} + vector(0.7),
                          vector(1), vector(0.1), 2 + 0.6 * uniform(random), 2000 + 500 * uniform(random),
                          static_cast<std::uint8_t>(k % 2)});
    return grains;
}

struct Sums {
    double mass = 0, momentum_size = 0, turning_size = 0;
    dem::Vector3<> momentum{}, angular_momentum{};
};

/// Summed plainly, from what every rank holds.
Sums sums_of(const Communicator& comm, const ParticleSet& grains) {
    const auto all = [&](const Field<double>& field, int axis) {
        return comm.all_gather(grains.own(field, axis));
    };
    const auto vectors = [&](const Field<double>& field) {
        const auto x = all(field, 0), y = all(field, 1), z = all(field, 2);
        std::vector<dem::Vector3<>> found;
        for (std::size_t i = 0; i < x.size(); ++i) found.push_back({x[i], y[i], z[i]});
        return found;
    };
    const auto mass = all(field::mass, 0), radius = all(field::radius, 0);
    const auto x = vectors(field::position), v = vectors(field::velocity),
               w = vectors(field::angular_velocity);
    Sums sums;
    for (std::size_t i = 0; i < mass.size(); ++i) {
        const dem::Vector3<> p = mass[i] * v[i],
                             l = cross(x[i], p) + 0.4 * mass[i] * radius[i] * radius[i] * w[i];
        sums.mass += mass[i];
        sums.momentum = sums.momentum + p;
        sums.angular_momentum = sums.angular_momentum + l;
        sums.momentum_size += norm(p);
        sums.turning_size += norm(l);
    }
    return sums;
}

void expect_same(const Sums& found, const Sums& expected) {
    EXPECT_NEAR(found.mass, expected.mass, rounding * expected.mass);
    EXPECT_LT(norm(found.momentum - expected.momentum), rounding * expected.momentum_size);
    EXPECT_LT(norm(found.angular_momentum - expected.angular_momentum), rounding * expected.turning_size);
}

TEST(ShrinkGrains, UntilTheyTouchAndNoFurther) {
    const Communicator world(MPI_COMM_WORLD), alone(MPI_COMM_SELF);
    const std::vector<GrainState> before = crowd();
    Box open;
    open.dimension = 3;
    ParticleSet grains = grain_set(world, before), serial = grain_set(alone, before);
    const Sums sums = sums_of(world, grains);
    const Shrunk shrunk = shrink_overlapping(world, open, grains);
    expect_same(sums_of(world, grains), sums);
    shrink_overlapping(alone, open, serial);
    EXPECT_EQ(state_hash(world, grains), state_hash(alone, serial));

    std::uint64_t smaller = 0;
    double least = 1;
    for (std::size_t i = 0; i < before.size(); ++i) {
        double factor = 1;
        for (std::size_t k = 0; k < before.size(); ++k)
            if (k != i)
                factor = std::min(factor, norm(before[i].position - before[k].position) /
                                              (before[i].radius + before[k].radius));
        std::size_t place = 0;
        while (serial.data(field::id)[place] != i) ++place;
        EXPECT_NEAR(serial.data(field::radius)[place], factor * before[i].radius, 1e-14 * before[i].radius);
        smaller += factor < 1 ? 1 : 0;
        least = std::min(least, factor);
    }
    EXPECT_EQ(shrunk.grains, smaller);
    EXPECT_GT(smaller, 200U);
    EXPECT_LT(smaller, before.size());
    EXPECT_NEAR(shrunk.least, least, 1e-14);
}

/// A scene that reads grains.h5 from `folder`, with more lines in its table of grains.
GrainScene scene_of(const Communicator& comm, const std::filesystem::path& folder, const std::string& lines) {
    const std::string text = R"([materials.rock]
density = 1
restitution = 0.5
friction = 0.5
[dem]
law = "linear"
stiffness = 1e6
[[grains]]
material = "rock"
file = "grains.h5"
)" + lines + "[run]\nend_time = 1\n";
    return read_grain_scene(comm, Scene::parse(text, folder / "scene.toml"));
}

ParticleSet written(const Communicator& comm, const std::filesystem::path& file) {
    ParticleSet grains = grain_set(comm, crowd());
    for (std::uint64_t& id : grains.own(field::id)) id = 7 * id + 3;
    write_particle_sets(comm, file, testing::some_state(7), {&grains});
    return grains;
}

TEST(HandedGrains, KeepMassMomentumAngularMomentumAndNames) {
    const Communicator comm(MPI_COMM_WORLD);
    const testing::SharedFolder folder(comm);
    const ParticleSet before = written(comm, folder.path / "grains.h5");
    const Sums sums = sums_of(comm, before);
    const GrainScene scene = scene_of(comm, folder.path, "");
    const ParticleSet grains = make_grains(comm, scene);
    expect_same(sums_of(comm, grains), sums);
    auto ids = comm.all_gather(grains.own(field::id)), expected = comm.all_gather(before.own(field::id));
    std::sort(ids.begin(), ids.end());
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(ids, expected);
    // The simulation counts their masses, not the density of the material.
    GrainSimulation run(comm, scene.simulation, grains);
    run.start();
    const GrainTotals totals = run.totals();
    EXPECT_NEAR(totals.mass, sums.mass, rounding * sums.mass);
    for (std::size_t a = 0; a < 3; ++a) {
        const std::array<double, 3> p{sums.momentum.x, sums.momentum.y, sums.momentum.z},
            l{sums.angular_momentum.x, sums.angular_momentum.y, sums.angular_momentum.z};
        EXPECT_NEAR(totals.momentum[a], p[a], rounding * sums.momentum_size);
        EXPECT_NEAR(totals.angular_momentum[a], l[a], rounding * sums.turning_size);
    }
}

TEST(HandedGrains, OfOneBodyTurnAndMove) {
    const Communicator comm(MPI_COMM_WORLD);
    const testing::SharedFolder folder(comm);
    const ParticleSet before = written(comm, folder.path / "grains.h5");
    const ParticleSet at_rest = make_grains(comm, scene_of(comm, folder.path, "of_body = 1\n")),
                      moving = make_grains(comm,
                                           scene_of(comm, folder.path,
                                                    "of_body = 1\nspin = [0, 0, 2]\nvelocity = [5, 0, 0]\n"));
    EXPECT_EQ(comm.all_sum(static_cast<std::uint64_t>(at_rest.size())), 200U);
    ASSERT_EQ(moving.size(), at_rest.size());
    const Sums first = sums_of(comm, at_rest), second = sums_of(comm, moving);
    EXPECT_NEAR(second.momentum.x - first.momentum.x, 5 * first.mass, 1e-11 * first.mass);
    EXPECT_NEAR(second.momentum.y, first.momentum.y, 1e-11 * first.mass);
    for (std::size_t i = 0; i < moving.size(); ++i) {
        EXPECT_EQ(moving.data(field::body)[i], 0);
        EXPECT_NEAR(moving.data(field::angular_velocity, 2)[i] - at_rest.data(field::angular_velocity, 2)[i],
                    2, 1e-14);
        // v_x falls by 2 for each metre along y.
        const double added = moving.data(field::velocity, 0)[i] - at_rest.data(field::velocity, 0)[i],
                     here = added + 2 * moving.data(field::position, 1)[i],
                     there = moving.data(field::velocity, 0)[0] - at_rest.data(field::velocity, 0)[0] +
                             2 * moving.data(field::position, 1)[0];
        EXPECT_NEAR(here, there, 1e-12);
    }
}

/// Some particles with ids and nothing else.
void number(const Communicator& comm, ParticleSet& set) {
    set.resize(comm.is_root() ? 400 : 0);
    for (std::size_t i = 0; i < set.size(); ++i) set.data(field::id)[i] = i;
}

TEST(HandedGrains, FaultsAreToldWithTheirFile) {
    const Communicator comm(MPI_COMM_WORLD);
    const testing::SharedFolder folder(comm);
    const auto fault_of = [&](const std::string& lines) -> std::string {
        try {
            scene_of(comm, folder.path, lines);
        } catch (const SceneError& error) {
            return error.what();
        }
        return "no fault";
    };
    const auto expect = [&](const std::string& lines, const std::string& fault) {
        const std::string found = fault_of(lines);
        EXPECT_NE(found.find(fault), std::string::npos) << found;
        EXPECT_NE(found.find("grains.h5"), std::string::npos) << found;
    };
    expect("", "no such checkpoint");
    ParticleSet others("sph", 3);
    others.add(field::velocity);
    number(comm, others);
    write_particle_sets(comm, folder.path / "grains.h5", testing::some_state(7), {&others});
    expect("", "particle set grains is not in it");
    ParticleSet without_radius("grains", 3);
    for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
             &field::velocity, &field::mass, &field::angular_velocity, &field::body})
        without_radius.add(*info);
    number(comm, without_radius);
    write_particle_sets(comm, folder.path / "grains.h5", testing::some_state(7), {&without_radius});
    expect("", "field radius is not in the file");
    ParticleSet grains = written(comm, folder.path / "grains.h5");
    expect("of_body = 9\n", "no such grains");
    for (double& mass : grains.own(field::mass)) mass = 0;
    write_particle_sets(comm, folder.path / "grains.h5", testing::some_state(7), {&grains});
    expect("", "has mass 0 kg");
}

}  // namespace
}  // namespace talus::test
