#include "src/run/restart.hpp"

#include <gtest/gtest.h>

#include "agreed_failure.hpp"
#include "io/checkpoint.hpp"
#include "random_particles.hpp"

namespace talus {
namespace {

using testing::agreed_failure;
using testing::SharedFolder;
using testing::some_state;

SceneSetup scene_of(const std::vector<std::string>& materials) {
    SceneSetup setup;
    setup.simulation.box.dimension = 2;
    for (const std::string& name : materials)
        setup.simulation.materials.push_back(Material{.name = name, .eos = IdealGas{}});
    return setup;
}

/// Writes a checkpoint of ten particles, which belong to the bodies in turn.
void write_bodies(const Communicator& comm, const std::filesystem::path& folder, const SceneSetup& setup,
                  bool name_materials) {
    ParticleSet particles = empty_particles(setup);
    if (comm.is_root()) particles.resize(10);
    for (std::size_t i = 0; i < particles.size(); ++i) {
        particles.data(field::id)[i] = i;
        particles.data(field::body)[i] = static_cast<std::uint8_t>(i % setup.simulation.materials.size());
    }
    RunState state = some_state(3);
    state.materials.clear();
    if (name_materials)
        for (const Material& material : setup.simulation.materials) state.materials.push_back(material.name);
    write_checkpoint(comm, folder, state, {&particles});
}

TEST(Restart, RefusesACheckpointOfOtherBodies) {
    const Communicator comm(MPI_COMM_WORLD);
    const SharedFolder folder(comm);
    write_bodies(comm, folder.path, scene_of({"rubber", "steel"}), true);
    const Restart same = read_restart(comm, "latest", folder.path, scene_of({"rubber", "steel"}));
    EXPECT_EQ(same.state.materials, (std::vector<std::string>{"rubber", "steel"}));
    EXPECT_EQ(comm.all_sum(static_cast<std::uint64_t>(same.particles.size())), 10U);
    for (const auto& materials : std::vector<std::vector<std::string>>{
             {"rubber"}, {"steel", "rubber"}, {"rubber", "steel", "steel"}}) {
        const std::string message = agreed_failure(
            comm, [&] { (void)read_restart(comm, "latest", folder.path, scene_of(materials)); });
        EXPECT_NE(message.find("is of a scene of 2 bodies (rubber, steel), this one has " +
                               std::to_string(materials.size())),
                  std::string::npos)
            << message;
    }
}

// As the first programs wrote them.
TEST(Restart, ChecksParticlesWhereTheCheckpointDoesNotNameMaterials) {
    const Communicator comm(MPI_COMM_WORLD);
    const SharedFolder folder(comm);
    write_bodies(comm, folder.path, scene_of({"rubber", "rubber"}), false);
    const Restart same = read_restart(comm, "latest", folder.path, scene_of({"rubber", "rubber"}));
    EXPECT_TRUE(same.state.materials.empty());
    const std::string message =
        agreed_failure(comm, [&] { (void)read_restart(comm, "latest", folder.path, scene_of({"rubber"})); });
    EXPECT_NE(message.find("holds particles of body 1, the scene has 1 body (rubber)"), std::string::npos)
        << message;
}

}  // namespace
}  // namespace talus
