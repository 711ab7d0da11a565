#include "src/setup/settle.hpp"

#include <gtest/gtest.h>

#include "tests/support/gathered.hpp"
#include "tests/support/settling_scene.hpp"

namespace talus::test {
namespace {

constexpr const char* second_ball = R"(
[[body]]
name = "moon"
material = "rock"
shape = "sphere"
radius = "20 km"
centre = ["100 km", 0, 0]
velocity = [0, 10, 0]
resolution = "same_mass"
damage = 0.5
)";

ParticleSet settled_particles(const Communicator& comm, const SceneSetup& scene) {
    ParticleSet particles = make_particles(comm, scene);
    settle(comm, scene, particles, [] {});
    return particles;
}

TEST(Settle, SameBitsOnAnyNumberOfRanks) {
    const auto hash_on = [](const Communicator& comm) {
        const SceneSetup scene = rock_ball(comm, 200, std::string(second_ball) + "[settle]\nimbalance = 0.3");
        return state_hash(comm, settled_particles(comm, scene));
    };
    const Communicator world(MPI_COMM_WORLD);
    EXPECT_EQ(hash_on(world), hash_on(Communicator(MPI_COMM_SELF)));
}

// Those that settle keep their centre of mass, flaws and damage and get their motion back; the others stay as
// they are.
TEST(Settle, ChangesTheBodiesThatAreNamedAlone) {
    const Communicator comm(MPI_COMM_SELF);
    const SceneSetup scene = rock_ball(comm, 200, std::string(second_ball) + "[settle]\nbodies = [\"moon\"]");
    const ParticleSet before = make_particles(comm, scene), after = settled_particles(comm, scene);
    ASSERT_EQ(before.size(), after.size());
    std::vector<std::size_t> at(before.size());
    for (std::size_t i = 0; i < after.size(); ++i) at[after.data(field::id)[i]] = i;
    double moved = 0;
    Point first_moment{};
    for (std::size_t i = 0; i < before.size(); ++i) {
        const std::size_t k = at[before.data(field::id)[i]];
        const bool is_moon = before.data(field::body)[i] == 1;
        EXPECT_EQ(before.data(field::body)[i], after.data(field::body)[k]);
        EXPECT_EQ(before.data(field::mass)[i], after.data(field::mass)[k]);
        EXPECT_EQ(before.data(field::damage)[i], after.data(field::damage)[k]);
        EXPECT_EQ(before.data(field::flaw_count)[i], after.data(field::flaw_count)[k]);
        EXPECT_EQ(after.data(field::deviatoric_stress)[k], 0);
        EXPECT_EQ(after.data(field::acceleration)[k], 0);
        for (int a = 0; a < 3; ++a) {
            const double shift = after.data(field::position, a)[k] - before.data(field::position, a)[i];
            if (is_moon) {
                moved = std::max(moved, std::abs(shift));
                first_moment[static_cast<std::size_t>(a)] += shift;
                EXPECT_EQ(after.data(field::velocity, a)[k], a == 1 ? 10 : 0);
            } else {
                EXPECT_EQ(shift, 0);
                EXPECT_EQ(after.data(field::velocity, a)[k], before.data(field::velocity, a)[i]);
            }
        }
    }
    EXPECT_GT(moved, 0.01);
    EXPECT_LT(norm(first_moment), 1e-6 * moved);
}

TEST(Settle, SaysSoWhenItTakesTooLong) {
    const Communicator comm(MPI_COMM_WORLD);
    const SceneSetup scene = rock_ball(comm, 200, "[settle]\nlongest = \"35 s\"");
    std::string message;
    try {
        settled_particles(comm, scene);
    } catch (const AgreedError& error) {
        message = error.what();
        EXPECT_EQ(error.exit_code, 1);
    }
    EXPECT_NE(message.find("settling body 'ball': not quiet after settle.longest = 35 s"), std::string::npos)
        << message;
}

TEST(Settle, RefusesScenesThatCannotSettle) {
    const Communicator comm(MPI_COMM_SELF);
    for (const auto& [table, why] : std::vector<std::pair<std::string, std::string>>{
             {"[settle]\nbodies = [\"bal\"]", "'bal' is no body that moves (allowed: ball)"},
             {"[settle]\nimbalance = 0", "settle.imbalance"},
             {"[settle]\nlongest = \"20 m\"", "settle.longest"},
             {"[settle]\nlongest = \"20 s\"", "must be quiet for"},
             {"[settle]\nuntil = 3", "settle.until"}})
        try {
            rock_ball(comm, 100, table);
            ADD_FAILURE() << table;
        } catch (const SceneError& error) {
            EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
        }
}

}  // namespace
}  // namespace talus::test
