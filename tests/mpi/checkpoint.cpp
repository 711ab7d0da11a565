#include "io/checkpoint.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <fstream>
#include <iterator>

#include "agreed_failure.hpp"
#include "io/checkpoint_layout.hpp"
#include "io/file_guard.hpp"
#include "io/hashing.hpp"
#include "io/id_order.hpp"
#include "random_particles.hpp"

namespace talus {
namespace {

using testing::agreed_failure;
using testing::random_set;
using testing::SharedFolder;
using testing::some_state;

constexpr std::uint64_t count = 3 * 4096 + 17;
constexpr std::uint64_t several_slabs = 2 * rows_per_slab + 4096 + 17;  // on one rank, and on each of two

std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

ParticleSet empty_set(int dimension = 3, const std::string& name = "rock") {
    ParticleSet set(name, dimension);
    testing::add_fields(set);
    return set;
}

TEST(Checkpoint, RoundTripIsExact) {
    const Communicator comm(MPI_COMM_WORLD);
    for (const int dimension : {1, 2, 3}) {
        const SharedFolder folder(comm);
        const ParticleSet rock = random_set(comm, several_slabs, 1, dimension);
        const ParticleSet dust = random_set(comm, 3, 2, dimension, "dust");
        const ParticleSet none = random_set(comm, 0, 2, dimension, "none");
        const RunState state = some_state(42);
        write_checkpoint(comm, folder.path, state, {&rock, &dust, &none});
        const auto file = find_checkpoint(comm, "latest", folder.path);
        EXPECT_EQ(file.filename(), "checkpoint_000000042.h5");

        ParticleSet rock_again = empty_set(dimension), dust_again = empty_set(dimension, "dust"),
                    none_again = empty_set(dimension, "none");
        const RunState again = read_checkpoint(comm, file, {&dust_again, &rock_again, &none_again});
        EXPECT_EQ(std::bit_cast<std::uint64_t>(again.time), std::bit_cast<std::uint64_t>(state.time));
        EXPECT_EQ(again.time_step, state.time_step);
        EXPECT_EQ(again.step, state.step);
        EXPECT_EQ(again.scene_text, state.scene_text);
        EXPECT_EQ(again.resolved_scene, state.resolved_scene);
        EXPECT_EQ(again.numbers, state.numbers);
        EXPECT_EQ(again.materials, state.materials);
        EXPECT_TRUE(std::signbit(again.numbers.at("energy at start")));
        EXPECT_EQ(comm.all_sum(rock_again.size()), several_slabs);
        EXPECT_EQ(none_again.size(), 0U);

        // Each particle's bits depend on its id only: make them again from the ids that were read.
        ParticleSet expected = empty_set(dimension);
        expected.resize(rock_again.size());
        std::copy_n(rock_again.data(field::id), rock_again.size(), expected.data(field::id));
        testing::fill(expected);
        for (const Column* column : state_columns(expected))
            EXPECT_EQ(column->components, rock_again.column(*column->info).components) << column->info->name;
        EXPECT_TRUE(std::is_sorted(rock_again.own(field::id).begin(), rock_again.own(field::id).end()));
        EXPECT_EQ(state_hash(comm, state, {&rock, &dust}),
                  state_hash(comm, again, {&dust_again, &rock_again}));
    }
}

TEST(Checkpoint, FileDoesNotDependOnRanksOrScattering) {
    const Communicator comm(MPI_COMM_WORLD);
    const Communicator self(MPI_COMM_SELF);
    const SharedFolder folder(comm);
    const ParticleSet here = random_set(comm, several_slabs, 1), there = random_set(comm, several_slabs, 2);
    write_checkpoint(comm, folder.path / "a", some_state(1), {&here});
    write_checkpoint(comm, folder.path / "b", some_state(1), {&there});
    if (comm.is_root()) {
        const ParticleSet alone = random_set(self, several_slabs, 3);
        write_checkpoint(self, folder.path / "c", some_state(1), {&alone});
        const std::string first = bytes_of(folder.path / "a/checkpoint_000000001.h5");
        EXPECT_GT(first.size(), several_slabs * here.bytes_per_particle() / 2);
        EXPECT_TRUE(first == bytes_of(folder.path / "b/checkpoint_000000001.h5"));
        EXPECT_TRUE(first == bytes_of(folder.path / "c/checkpoint_000000001.h5"));
    }
}

TEST(Checkpoint, IsReadOnAnotherNumberOfRanks) {
    const Communicator comm(MPI_COMM_WORLD);
    const SharedFolder folder(comm);
    const ParticleSet set = random_set(comm, count, 1);
    write_checkpoint(comm, folder.path, some_state(7), {&set});
    const std::string hash = state_hash(comm, some_state(7), {&set});
    MPI_Comm part = MPI_COMM_NULL;
    MPI_Comm_split(comm.handle(), comm.rank() < 2 ? 0 : 1, 0, &part);
    {
        const Communicator fewer(part);
        ParticleSet again = empty_set();
        const auto file = find_checkpoint(fewer, folder.path, "");
        const RunState state = read_checkpoint(fewer, file, {&again});
        EXPECT_EQ(state_hash(fewer, state, {&again}), hash);
        EXPECT_EQ(read_checkpoint_state(fewer, file).scene_text, state.scene_text);
    }
    MPI_Comm_free(&part);
}

TEST(Checkpoint, KeepsTheNewestTwo) {
    const Communicator comm(MPI_COMM_WORLD);
    const SharedFolder folder(comm);
    const ParticleSet set = random_set(comm, 100, 1);
    if (comm.is_root()) std::ofstream(folder.path / "checkpoint_000000003.h5.tmp") << "left by a killed run";
    for (const std::uint64_t step : {5U, 10U, 20U, 30U})
        write_checkpoint(comm, folder.path, some_state(step), {&set});
    const auto files = list_checkpoints(folder.path);
    ASSERT_EQ(files.size(), 2U);
    EXPECT_EQ(files[0].filename(), "checkpoint_000000030.h5");
    EXPECT_EQ(files[1].filename(), "checkpoint_000000020.h5");
    const auto entries = std::filesystem::directory_iterator(folder.path);
    EXPECT_EQ(std::distance(begin(entries), end(entries)), 2);
}

TEST(Checkpoint, ARunThatWentBackKeepsItsOwn) {
    const Communicator comm(MPI_COMM_WORLD);
    const SharedFolder folder(comm);
    const ParticleSet set = random_set(comm, 100, 1);
    for (const std::uint64_t step : {10U, 20U, 15U})
        write_checkpoint(comm, folder.path, some_state(step), {&set});
    const auto files = list_checkpoints(folder.path);
    ASSERT_EQ(files.size(), 2U);
    EXPECT_EQ(files[0].filename(), "checkpoint_000000015.h5");
    EXPECT_EQ(files[1].filename(), "checkpoint_000000010.h5");
    EXPECT_TRUE(std::filesystem::exists(folder.path / "checkpoint_000000020.h5.superseded"));
}

TEST(Checkpoint, ADoubleIdIsRefused) {
    const Communicator comm(MPI_COMM_WORLD);
    const SharedFolder folder(comm);
    ParticleSet set = random_set(comm, count, 1);
    const std::size_t large = set.size() > 10 ? 1 : 0;
    if (comm.all_exclusive_sum(large) == 0 && large == 1) set.own(field::id)[3] = set.own(field::id)[7];
    const std::string message =
        agreed_failure(comm, [&] { write_checkpoint(comm, folder.path, some_state(1), {&set}); });
    EXPECT_NE(message.find("particle set rock: "), std::string::npos) << message;
    EXPECT_NE(message.find("occurs twice"), std::string::npos) << message;
    EXPECT_TRUE(list_checkpoints(folder.path).empty());
}

TEST(Checkpoint, OtherFieldsAreRefusedByName) {
    const Communicator comm(MPI_COMM_WORLD);
    const SharedFolder folder(comm);
    const ParticleSet set = random_set(comm, 100, 1);
    write_checkpoint(comm, folder.path, some_state(1), {&set});
    const auto file = find_checkpoint(comm, "latest", folder.path);
    const auto refused = [&](ParticleSet& into) {
        return agreed_failure(comm, [&] { read_checkpoint(comm, file, {&into}); });
    };
    ParticleSet more = empty_set(), fewer("rock", 3), flat = empty_set(2), other = empty_set(3, "sand");
    more.add(field::damage);
    EXPECT_EQ(refused(more),
              file.string() + ": particle set rock: field damage is not in the file, but the scene needs it");
    EXPECT_EQ(
        refused(fewer),
        file.string() + ": particle set rock: field body is in the file, but the scene does not have it");
    EXPECT_EQ(refused(flat), file.string() + ": particle set rock: has 3 dimensions, the scene 2");
    EXPECT_EQ(refused(other), file.string() + ": particle set sand is not in it");
}

/// Writes two checkpoints and applies `damage` to the bytes of the newer.
template <class Damage>
std::string failure_after(const Communicator& comm, const std::filesystem::path& folder,
                          const Damage& damage) {
    const ParticleSet set = random_set(comm, count, 1);
    for (const std::uint64_t step : {1U, 2U}) write_checkpoint(comm, folder, some_state(step), {&set});
    const auto file = folder / "checkpoint_000000002.h5";
    if (comm.is_root()) {
        std::string bytes = bytes_of(file);
        damage(bytes);
        std::ofstream(file, std::ios::binary) << bytes;
    }
    comm.all_barrier();
    ParticleSet again = empty_set();
    return agreed_failure(comm, [&] { read_checkpoint(comm, file, {&again}); });
}

TEST(Checkpoint, AFlippedBitIsFoundAndItsDatasetNamed) {
    const Communicator comm(MPI_COMM_WORLD);
    const SharedFolder folder(comm);
    std::uint64_t id = 5 + 3 * 4321;  // a value that stands once in the file: in /sets/rock/id
    const std::string message = failure_after(comm, folder.path, [&](std::string& bytes) {
        const auto at = bytes.find(std::string(reinterpret_cast<const char*>(&id), sizeof id));
        ASSERT_NE(at, std::string::npos);
        bytes[at] = static_cast<char>(bytes[at] ^ 1);
    });
    const std::string path = folder.path.string();
    EXPECT_EQ(message,
              path +
                  "/checkpoint_000000002.h5: /sets/rock/id: damaged, checksum does not match; the checkpoint "
                  "before it is there: --restart " +
                  path + "/checkpoint_000000001.h5");
}

TEST(Checkpoint, DamagedMetadataNeverReachHdf5) {
    const Communicator comm(MPI_COMM_WORLD);
    const SharedFolder folder(comm);
    const std::string message =
        failure_after(comm, folder.path, [&](std::string& bytes) { bytes[bytes.find("end_time")] = 'E'; });
    EXPECT_NE(message.find(": metadata: damaged, checksum does not match; the checkpoint before it"),
              std::string::npos)
        << message;
}

// Of a program to come, whole otherwise; the one before it can be read.
TEST(Checkpoint, AnotherFormatVersionIsRefused) {
    const Communicator comm(MPI_COMM_WORLD);
    const SharedFolder folder(comm);
    const ParticleSet set = random_set(comm, 100, 1);
    for (const std::uint64_t step : {1U, 2U}) write_checkpoint(comm, folder.path, some_state(step), {&set});
    const std::filesystem::path newer = folder.path / "checkpoint_000000002.h5",
                                older = folder.path / "checkpoint_000000001.h5";
    if (comm.is_root()) {
        hdf5::change_attribute(hdf5::open_file(newer, true), "format_version", checkpoint_format_version + 1);
        std::fstream(newer, std::ios::binary | std::ios::in | std::ios::out)
            << std::string(guard_size(0), '\0');
        write_guard(newer, {});
    }
    comm.all_barrier();
    ParticleSet again = empty_set();
    EXPECT_EQ(agreed_failure(comm, [&] { read_checkpoint(comm, newer, {&again}); }),
              newer.string() +
                  ": format version 2, this program reads 1; the checkpoint before it is there: "
                  "--restart " +
                  older.string());
    EXPECT_EQ(read_checkpoint(comm, older, {&again}).step, 1U);
}

TEST(Checkpoint, ACutFileIsRefused) {
    const Communicator comm(MPI_COMM_WORLD);
    for (const std::size_t left : {std::size_t{0}, std::size_t{20}, std::size_t{1000}, std::size_t{500000}}) {
        const SharedFolder folder(comm);
        const std::string message =
            failure_after(comm, folder.path, [&](std::string& bytes) { bytes.resize(left); });
        const std::string section = left < 100 ? ": index: cut short, " : ": /sets/rock/";
        EXPECT_NE(message.find(section), std::string::npos) << message;
        EXPECT_NE(message.find("cut short, "), std::string::npos) << message;
    }
}

TEST(Checkpoint, EveryFlippedBitIsFound) {
    const Communicator comm(MPI_COMM_WORLD);
    const Communicator self(MPI_COMM_SELF);
    const SharedFolder folder(comm);
    if (!comm.is_root()) return;
    const ParticleSet set = random_set(self, 50, 1);
    write_checkpoint(self, folder.path, some_state(1), {&set});
    const auto file = folder.path / "checkpoint_000000001.h5";
    const std::string intact = bytes_of(file);
    for (std::size_t at = 0; at < intact.size(); at += 7) {
        std::string bytes = intact;
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << (at % 8)));
        std::ofstream(file, std::ios::binary) << bytes;
        ParticleSet again = empty_set();
        EXPECT_THROW(read_checkpoint(self, file, {&again}), AgreedError) << "byte " << at;
    }
}

TEST(Checkpoint, MissingOnesAreNamed) {
    const Communicator comm(MPI_COMM_WORLD);
    const SharedFolder folder(comm);
    const std::string path = folder.path.string();
    EXPECT_EQ(agreed_failure(comm, [&] { find_checkpoint(comm, "latest", folder.path); }),
              path + ": no checkpoint in this folder");
    EXPECT_EQ(agreed_failure(comm, [&] { find_checkpoint(comm, path + "/x.h5", ""); }),
              path + "/x.h5: no such checkpoint");
    EXPECT_NE(agreed_failure(comm, [&] { write_checkpoint(comm, "/proc/nowhere", some_state(1), {}); })
                  .find("/proc/nowhere"),
              std::string::npos);
}

TEST(StateHash, TellsEveryDifference) {
    const Communicator comm(MPI_COMM_WORLD);
    ParticleSet set = random_set(comm, count, 1);
    const RunState state = some_state(1);
    const std::string hash = state_hash(comm, state, {&set});
    EXPECT_EQ(hash.size(), 32U);
    const ParticleSet scattered = random_set(comm, count, 9);
    EXPECT_EQ(hash, state_hash(comm, state, {&scattered}));
    RunState later = state;
    later.numbers["work"] = 1e-323;
    EXPECT_NE(hash, state_hash(comm, later, {&set}));
    if (set.size() > 0) set.own(field::body)[0] ^= 1;
    EXPECT_NE(hash, state_hash(comm, state, {&set}));
    if (set.size() > 0) set.own(field::body)[0] ^= 1;
    EXPECT_EQ(hash, state_hash(comm, state, {&set}));
}

}  // namespace
}  // namespace talus
