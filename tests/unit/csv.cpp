#include "io/csv.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/support/own_folder.hpp"

namespace talus {
namespace {

std::string content(const std::filesystem::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

class Csv : public ::testing::Test {
  protected:
    const Communicator comm{MPI_COMM_SELF};
    const test::OwnFolder folder;
    const std::filesystem::path file = folder.path / "energies.csv";
    const std::vector<CsvColumn> columns{{"time", "s"}, {"kinetic_energy", "J"}, {"count", "1"}};
};

TEST_F(Csv, WritesShortestExactNumbers) {
    CsvWriter table(comm, file, columns);
    table.write(0, std::vector{0.1, 1.0 / 3, 5.0});
    table.write(1, std::vector{-0.0, 1e-300, 1e22});
    EXPECT_EQ(content(file),
              "step,time [s],kinetic_energy [J],count\n0,0.1,0.3333333333333333,5\n1,-0,1e-300,1e+22\n");
}

TEST_F(Csv, ARestartGoesOnAfterItsStep) {
    {
        CsvWriter table(comm, file, columns);
        for (std::uint64_t step = 0; step < 10; step += 2) table.write(step, std::vector{1.0, 2.0, 3.0});
    }
    std::ofstream(file, std::ios::app) << "10,1,2";  // killed while writing
    CsvWriter table(comm, file, columns, 5);
    table.write(6, std::vector{7.0, 8.0, 9.0});
    EXPECT_EQ(content(file), "step,time [s],kinetic_energy [J],count\n0,1,2,3\n2,1,2,3\n4,1,2,3\n6,7,8,9\n");
}

TEST_F(Csv, ARestartWithoutFileBeginsOne) {
    CsvWriter table(comm, file, columns, 5);
    EXPECT_EQ(content(file), "step,time [s],kinetic_energy [J],count\n");
}

TEST_F(Csv, OtherColumnsAreRefused) {
    { CsvWriter table(comm, file, {{"time", "s"}}); }
    EXPECT_THROW(CsvWriter(comm, file, columns, 5), AgreedError);
    EXPECT_EQ(content(file), "step,time [s]\n");
}

TEST_F(Csv, ARowThatDoesNotFitIsTakenBack) {
    CsvWriter table(comm, file, columns);
    table.write(0, std::vector{1.0, 2.0, 3.0});
    const std::string before = content(file);
    rlimit old{};
    getrlimit(RLIMIT_FSIZE, &old);
    const rlimit small{before.size() + 4, old.rlim_max};
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &small);
    EXPECT_THROW(table.write(1, std::vector{1.0, 2.0, 3.0}), AgreedError);
    setrlimit(RLIMIT_FSIZE, &old);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(content(file), before);
}

}  // namespace
}  // namespace talus
