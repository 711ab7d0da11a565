#include <gtest/gtest.h>

#include "src/setup/scene_setup.hpp"
#include "tests/support/gathered.hpp"

namespace talus::test {
namespace {

// A glass in the surface of a shape file, spinning, and an impactor of equal particle masses; every rank
// makes its share.
TEST(SceneSetup, MakesTheSameBitsOnAnyNumberOfRanks) {
    const std::string file = TALUS_SOURCE_DIR "/runs/bilobed_impact/scene.toml";
    const auto hash_on = [&](const Communicator& comm) {
        const Scene scene = Scene::parse(Scene::read_text(file), file, true);
        const SceneSetup setup = read_scene(comm, scene);
        const ParticleSet particles = make_particles(comm, setup);
        EXPECT_EQ(comm.all_sum(static_cast<std::uint64_t>(particles.size())),
                  setup.census[0].count + setup.census[1].count);
        return state_hash(comm, particles);
    };
    const Communicator world(MPI_COMM_WORLD);
    const std::uint64_t found = hash_on(world);
    if (world.is_root()) {
        EXPECT_EQ(found, hash_on(Communicator(MPI_COMM_SELF)));
    }
}

}  // namespace
}  // namespace talus::test
