#include "comm/exact_sum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "domain/random.hpp"

namespace talus {
namespace {

TEST(ExactSumOverRanks, TotalDoesNotDependOnTheShares) {
    const Communicator comm(MPI_COMM_WORLD);
    constexpr RandomStream draws{.seed = 8};
    std::vector<double> terms;
    for (std::uint64_t k = 0; k < 2000; ++k)
        terms.push_back((draws.uniform(k, 0) - 0.5) * std::exp2(600 * (draws.uniform(k, 1) - 0.5)));
    ExactSum serial;
    serial.add(terms);
    for (const std::size_t stride : {1u, 7u, 100u}) {
        std::vector<ExactSum> sums(3);
        for (std::size_t k = 0; k < terms.size(); ++k)
            if (k / stride % static_cast<std::size_t>(comm.size()) == static_cast<std::size_t>(comm.rank())) {
                sums[0].add(terms[k]);
                sums[1].add(-terms[k]);
            }
        if (comm.rank() == comm.size() - 1) sums[2].add(std::numeric_limits<double>::infinity());
        ExactSum::all_reduce(comm, sums);
        EXPECT_EQ(sums[0].value(), serial.value());
        EXPECT_EQ(sums[1].value(), -serial.value());
        EXPECT_TRUE(std::isnan(sums[2].value()));
    }
}

TEST(ExactSumOverRanks, RanksCancel) {
    const Communicator comm(MPI_COMM_WORLD);
    std::vector<ExactSum> sums(1);
    if (comm.rank() == 0) sums[0].add(1e300);
    if (comm.rank() == comm.size() - 1) sums[0].add(-1e300);
    sums[0].add(1e-300);
    ExactSum::all_reduce(comm, sums);
    EXPECT_NEAR(sums[0].value() / (comm.size() * 1e-300), 1, 1e-15);
    sums[0].add(0.5);  // a total may be added to
    EXPECT_EQ(sums[0].value(), 0.5);
}

}  // namespace
}  // namespace talus
