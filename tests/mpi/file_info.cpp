#include "io/file_info.hpp"

#include <gtest/gtest.h>
#include <sys/mount.h>

#include <fstream>

#include "io/checkpoint.hpp"
#include "io/hashing.hpp"
#include "io/progress.hpp"
#include "io/snapshot.hpp"
#include "random_particles.hpp"

namespace talus {
namespace {

using testing::random_set;
using testing::SharedFolder;
using testing::some_state;

TEST(FileInfo, HashOfAFileIsThatOfTheState) {
    const Communicator comm(MPI_COMM_WORLD);
    const SharedFolder folder(comm);
    const ParticleSet rock = random_set(comm, 9000, 1), dust = random_set(comm, 5, 1, 3, "dust");
    write_checkpoint(comm, folder.path, some_state(1), {&rock, &dust});
    write_checkpoint(comm, folder.path, some_state(2), {&rock, &dust});
    const std::string one = state_hash(comm, some_state(1), {&dust, &rock}),
                      two = state_hash(comm, some_state(2), {&rock, &dust});
    EXPECT_NE(one, two);
    if (!comm.is_root()) return;
    EXPECT_EQ(hash_file(folder.path), two);
    EXPECT_EQ(hash_file(folder.path / "checkpoint_000000001.h5"), one);
    EXPECT_THROW(hash_file(folder.path / "nothing.h5"), AgreedError);
}

TEST(FileInfo, DescribesCheckpointsAndSnapshots) {
    const Communicator comm(MPI_COMM_WORLD);
    const SharedFolder folder(comm);
    ParticleSet set = random_set(comm, 5000, 1);
    for (double& mass : set.own(field::mass)) mass = 2.5;
    for (int c = 0; c < 3; ++c)
        for (double& v : set.own(field::velocity, c)) v = c == 2 ? 0 : 3.0 + c;
    write_checkpoint(comm, folder.path, some_state(7), {&set});
    write_snapshot(comm, folder.path, 0, some_state(7), set, {{&field::mass}});
    if (!comm.is_root()) return;
    const std::string checkpoint = describe_file(folder.path / "checkpoint_000000007.h5").text;
    for (const char* part : {"checkpoint (format 1) of talus 0.1", "step 7, time 0.3333333333333333 s",
                             "set rock: 5000 particles in 3 dimensions", "kg        2.5 to 2.5",
                             "length 5 to 5", "work = 5e-324", "checksums: all match"})
        EXPECT_NE(checkpoint.find(part), std::string::npos) << part << "\n" << checkpoint;
    const std::string snapshot = describe_file(folder.path / "rock_000000.hdf").text;
    for (const char* part :
         {"snapshot (format 1)", "set rock: 5000 particles", "Masses", "kg        2.5 to 2.5", "all match"})
        EXPECT_NE(snapshot.find(part), std::string::npos) << part << "\n" << snapshot;
    std::ofstream(folder.path / "text.h5") << "no such thing";
    EXPECT_THROW(describe_file(folder.path / "text.h5"), AgreedError);
}

TEST(FullDisk, IsReportedByAllAndLeavesTheOldFiles) {
    const Communicator comm(MPI_COMM_WORLD);
    const SharedFolder folder(comm);
    int mounted = 0;
    if (comm.is_root()) mounted = ::mount("tmpfs", folder.path.c_str(), "tmpfs", 0, "size=4m") == 0 ? 1 : 0;
    if (comm.all_max(mounted) == 0) GTEST_SKIP() << "needs the right to mount a small file system";
    const ParticleSet small = random_set(comm, 5000, 1), large = random_set(comm, 20000, 1),
                      fitting = random_set(comm, 9500, 1);
    write_checkpoint(comm, folder.path, some_state(1), {&small});
    for (const ParticleSet* set : {&large, &fitting}) {
        try {
            write_checkpoint(comm, folder.path, some_state(2), {set});
            write_checkpoint(comm, folder.path, some_state(3), {set});
            ADD_FAILURE() << "written to a full disk";
        } catch (const AgreedError& failure) {
            EXPECT_EQ(failure.exit_code, 3);
            EXPECT_NE(std::string(failure.what()).find("no space: needs "), std::string::npos)
                << failure.what();
        }
    }
    comm.all_barrier();
    for (const auto& file : list_checkpoints(folder.path)) {
        EXPECT_EQ(hash_file(file).size(), 32U);
    }
    EXPECT_FALSE(list_checkpoints(folder.path).empty());
    comm.all_barrier();
    if (comm.is_root()) ::umount(folder.path.c_str());
}

TEST(PhaseTimer, AddsUpOverRanks) {
    const Communicator comm(MPI_COMM_WORLD);
    PhaseTimer timer;
    for (int k = 0; k < 3; ++k) const auto timing = timer.start("everywhere");
    if (comm.rank() == comm.size() - 1) const auto timing = timer.start("last only");
    const auto rows = timer.rows(comm);
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[0].phase, "everywhere");
    EXPECT_EQ(rows[0].calls, 3U);
    EXPECT_EQ(rows[1].calls, 1U);
    EXPECT_GE(rows[1].imbalance(), comm.size() - 1e-9);
    EXPECT_LE(rows[0].least, rows[0].average * (1 + 1e-12));
    const std::string report = timer.report(comm, 1);
    EXPECT_NE(report.find("last only"), std::string::npos) << report;
    EXPECT_NE(report.find("peak memory"), std::string::npos) << report;
}

}  // namespace
}  // namespace talus
