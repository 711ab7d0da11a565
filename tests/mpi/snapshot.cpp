#include "io/snapshot.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "io/hdf5_file.hpp"
#include "random_particles.hpp"

namespace talus {
namespace {

using testing::random_set;
using testing::SharedFolder;
using testing::some_state;

constexpr std::uint64_t count = 2 * 4096;  // whole blocks: the extra offset of VTK begins a new one

std::string content(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

const std::vector<SnapshotField> fields = {{&field::velocity, true},
                                           {&field::mass},
                                           {&field::deviatoric_stress},
                                           {&field::velocity_gradient},
                                           {&field::body},
                                           {&field::flaw_threshold},
                                           {&field::density, false, "Rho", "my words"}};

template <class T>
std::vector<T> read_all(hid_t file, const std::string& path, hid_t type, std::size_t values) {
    std::vector<T> read(values);
    const hdf5::Handle dataset = hdf5::open_dataset(file, path);
    const hdf5::Handle space(H5Dget_space(dataset), H5Sclose, "examine");
    EXPECT_EQ(H5Sget_simple_extent_npoints(space), static_cast<hssize_t>(values)) << path;
    EXPECT_GE(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, read.data()), 0) << path;
    return read;
}

TEST(Snapshot, NamesUnitsAndValues) {
    const Communicator comm(MPI_COMM_WORLD);
    const SharedFolder folder(comm);
    ParticleSet set = random_set(comm, count, 1);
    for (std::size_t k = 0; k < set.size(); ++k)
        for (int c = 0; c < 6; ++c)
            set.own(field::deviatoric_stress, c)[k] = 10.0 * static_cast<double>(set.own(field::id)[k]) + c;
    write_snapshot(comm, folder.path, 12, some_state(3), set, fields);
    if (!comm.is_root()) return;
    const hdf5::Handle file = hdf5::open_file(folder.path / "rock_000012.hdf", false);
    const auto ids = read_all<std::uint64_t>(file, "/PartType0/ParticleIDs", H5T_NATIVE_UINT64, count);
    EXPECT_TRUE(std::is_sorted(ids.begin(), ids.end()));
    const auto stress = read_all<double>(file, "/PartType0/StressDeviator", H5T_NATIVE_DOUBLE, 6 * count);
    for (const std::size_t k : {std::size_t{0}, count / 2, count - 1}) {
        const double base = 10.0 * static_cast<double>(ids[k]);
        const std::vector<double> found(stress.begin() + static_cast<std::ptrdiff_t>(6 * k),
                                        stress.begin() + static_cast<std::ptrdiff_t>(6 * k + 6));
        EXPECT_EQ(found, (std::vector<double>{base, base + 1, base + 2, base + 3, base + 5,
                                              base + 4}));  // VTK's order
    }
    const hdf5::Handle velocities = hdf5::open_dataset(file, "/PartType0/Velocities");
    EXPECT_EQ(hdf5::text_attribute(velocities, "units"), "m s-1");
    EXPECT_EQ(hdf5::text_attribute(velocities, "description"), "velocity");
    EXPECT_EQ(hdf5::double_attribute(velocities, "unitSI"), 1.0);
    EXPECT_EQ(hdf5::extent_of(velocities).type, ValueType::f32);
    EXPECT_EQ(hdf5::text_attribute(hdf5::open_dataset(file, "/rock/Rho"), "description"), "my words");
    EXPECT_EQ(hdf5::children(hdf5::open_group(file, "/PartType0")),
              (std::vector<std::string>{"BodyIDs", "Coordinates", "FlawThreshold", "Masses", "ParticleIDs",
                                        "Rho", "StressDeviator", "Velocities", "VelocityGradient"}));
    EXPECT_EQ(hdf5::double_attribute(hdf5::open_group(file, "/Header"), "Time"), 1.0 / 3);
}

TEST(Snapshot, HasTheViewThatParaViewReads) {
    const Communicator comm(MPI_COMM_WORLD);
    const SharedFolder folder(comm);
    const ParticleSet set = random_set(comm, count, 1);
    write_snapshot(comm, folder.path, 0, some_state(3), set, fields);
    if (!comm.is_root()) return;
    const hdf5::Handle file = hdf5::open_file(folder.path / "rock_000000.hdf", false);
    const hdf5::Handle view = hdf5::open_group(file, "/VTKHDF");
    const hdf5::Handle type(H5Aopen(view, "Type", H5P_DEFAULT), H5Aclose, "open Type");
    const hdf5::Handle text(H5Aget_type(type), H5Tclose, "examine Type");
    EXPECT_EQ(H5Tis_variable_str(text), 0);
    EXPECT_EQ(H5Tget_size(text), std::string_view("UnstructuredGrid").size());
    EXPECT_EQ(read_all<std::int64_t>(file, "/VTKHDF/NumberOfPoints", H5T_NATIVE_INT64, 1).at(0),
              static_cast<std::int64_t>(count));
    const auto offsets = read_all<std::uint64_t>(file, "/VTKHDF/Connectivity", H5T_NATIVE_UINT64, count + 1);
    for (std::uint64_t k = 0; k <= count; ++k) ASSERT_EQ(offsets[k], k);
    const auto types = read_all<std::uint8_t>(file, "/VTKHDF/Types", H5T_NATIVE_UINT8, count);
    EXPECT_EQ(std::count(types.begin(), types.end(), 1), static_cast<std::ptrdiff_t>(count));
    for (const auto& [a, b] : {std::pair("/VTKHDF/Points", "/PartType0/Coordinates"),
                               std::pair("/VTKHDF/PointData/Velocities", "/PartType0/Velocities"),
                               std::pair("/VTKHDF/Offsets", "/VTKHDF/Connectivity")}) {
        H5O_info_t first, second;
        H5Oget_info_by_name2(file, a, &first, H5O_INFO_BASIC, H5P_DEFAULT);
        H5Oget_info_by_name2(file, b, &second, H5O_INFO_BASIC, H5P_DEFAULT);
        EXPECT_EQ(first.addr, second.addr) << a;  // one dataset with two names
    }
}

TEST(Snapshot, FlatRunsAreCompletedToThreeDimensions) {
    const Communicator comm(MPI_COMM_WORLD);
    for (const int dimension : {1, 2}) {
        const SharedFolder folder(comm);
        ParticleSet set = random_set(comm, 10, 1, dimension);
        for (std::size_t k = 0; k < set.size(); ++k)
            for (int c = 0; c < component_count(Shape::symmetric_tensor, dimension); ++c)
                set.own(field::deviatoric_stress, c)[k] = 2.0 + c;
        write_snapshot(comm, folder.path, 0, some_state(3), set, fields);
        if (!comm.is_root()) continue;
        const hdf5::Handle file = hdf5::open_file(folder.path / "rock_000000.hdf", false);
        const auto points = read_all<double>(file, "/PartType0/Coordinates", H5T_NATIVE_DOUBLE, 30);
        EXPECT_EQ(points[2], 0);
        auto stress = read_all<double>(file, "/PartType0/StressDeviator", H5T_NATIVE_DOUBLE, 60);
        stress.resize(6);
        EXPECT_EQ(stress, dimension == 1 ? (std::vector<double>{2, -1, -1, 0, 0, 0})
                                         : (std::vector<double>{2, 3, -5, 4, 0, 0}));
        const auto gradient = read_all<double>(file, "/PartType0/VelocityGradient", H5T_NATIVE_DOUBLE, 90);
        EXPECT_EQ(gradient[8], 0);
    }
}

TEST(Snapshot, DoesNotDependOnScattering) {
    const Communicator comm(MPI_COMM_WORLD);
    const Communicator self(MPI_COMM_SELF);
    const SharedFolder folder(comm);
    const ParticleSet set = random_set(comm, count, 1);
    write_snapshot(comm, folder.path / "a", 0, some_state(3), set, fields);
    if (!comm.is_root()) return;
    const ParticleSet alone = random_set(self, count, 5);
    write_snapshot(self, folder.path / "b", 0, some_state(3), alone, fields);
    EXPECT_TRUE(content(folder.path / "a/rock_000000.hdf") == content(folder.path / "b/rock_000000.hdf"));
}

TEST(Snapshot, SeriesFollowsARestart) {
    const Communicator comm(MPI_COMM_WORLD);
    const SharedFolder folder(comm);
    const ParticleSet set = random_set(comm, 10, 1);
    RunState state = some_state(1);
    for (const std::uint64_t index : {0U, 1U, 2U, 3U, 2U}) {  // restarted between 1 and 2
        state.time = 0.5 * static_cast<double>(index);
        write_snapshot(comm, folder.path, index, state, set, {});
    }
    if (!comm.is_root()) return;
    EXPECT_EQ(content(folder.path / "rock.hdf.series"),
              "{\n  \"file-series-version\": \"1.0\",\n  \"files\": [\n    {\"name\": \"rock_000000.hdf\", "
              "\"time\": 0},\n"
              "    {\"name\": \"rock_000001.hdf\", \"time\": 0.5},\n    {\"name\": \"rock_000002.hdf\", "
              "\"time\": 1}\n  ]\n}\n");
}

TEST(Snapshot, NamesOfFields) {
    EXPECT_EQ(snapshot_name(field::internal_energy), "InternalEnergies");
    EXPECT_EQ(snapshot_name(field::flaw_threshold), "FlawThreshold");
    EXPECT_EQ(snapshot_name(field::damage), "Damage");
}

}  // namespace
}  // namespace talus
