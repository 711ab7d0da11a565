#include <gtest/gtest.h>
#include <mpi.h>

/// Runs every test on every rank. A failure on one rank fails the whole run; ranks other than the first
/// print only their failures.
int main(int argc, char** argv) {
    MPI_Init(&argc, &argv);
    testing::InitGoogleTest(&argc, argv);
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    if (rank != 0) {
        auto& listeners = testing::UnitTest::GetInstance()->listeners();
        delete listeners.Release(listeners.default_result_printer());
    }
    int failed = RUN_ALL_TESTS();
    if (failed != 0 && rank != 0) {
        const auto& unit = *testing::UnitTest::GetInstance();
        for (int s = 0; s < unit.total_test_suite_count(); ++s)
            for (int t = 0; t < unit.GetTestSuite(s)->total_test_count(); ++t) {
                const auto& info = *unit.GetTestSuite(s)->GetTestInfo(t);
                for (int p = 0; p < info.result()->total_part_count(); ++p) {
                    const auto& part = info.result()->GetTestPartResult(p);
                    if (part.failed())
                        std::fprintf(stderr, "rank %d: %s.%s: %s:%d: %s\n", rank, info.test_suite_name(),
                                     info.name(), part.file_name() ? part.file_name() : "?",
                                     part.line_number(), part.summary());
                }
            }
    }
    MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    MPI_Finalize();
    return failed;
}
