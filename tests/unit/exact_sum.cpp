#include "comm/exact_sum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "domain/random.hpp"

namespace talus {
namespace {

double sum(std::initializer_list<double> terms) {
    ExactSum exact;
    for (const double term : terms) exact.add(term);
    return exact.value();
}

TEST(ExactSum, SmallSums) {
    EXPECT_EQ(ExactSum{}.value(), 0);
    EXPECT_EQ(sum({1, 2, 3.5}), 6.5);
    EXPECT_EQ(sum({-1, -2, 3}), 0);
    EXPECT_EQ(sum({-1, -2.25}), -3.25);
    EXPECT_EQ(sum({0.0, -0.0}), 0);
}

TEST(ExactSum, CancellationLeavesTheSmallTerms) {
    EXPECT_EQ(sum({1e300, 1, -1e300}), 1);
    EXPECT_EQ(sum({1e300, -3e-300, -1e300}), -3e-300);
    EXPECT_EQ(sum({-1e300, 1e-16, 1e300, 1, -1}), 1e-16);
}

TEST(ExactSum, OneTermComesBackWhateverItsSize) {
    constexpr RandomStream draws{.seed = 4};
    for (std::uint64_t k = 0; k < 20000; ++k) {
        const double x =
            std::ldexp(draws.uniform(k, 0) - 0.5, static_cast<int>(2120 * draws.uniform(k, 1)) - 1097);
        EXPECT_EQ(sum({x}), x);
    }
    constexpr double largest = std::numeric_limits<double>::max(),
                     tiniest = std::numeric_limits<double>::denorm_min(),
                     normal = std::numeric_limits<double>::min();
    for (const double x : {largest, -largest, tiniest, -tiniest, normal, normal - tiniest, tiniest - normal})
        EXPECT_EQ(sum({x}), x);
}

TEST(ExactSum, Subnormals) {
    constexpr double tiniest = std::numeric_limits<double>::denorm_min();
    ExactSum exact;
    for (int k = 0; k < 1000; ++k) exact.add(tiniest);
    EXPECT_EQ(exact.value(), 1000 * tiniest);
    exact.add(std::numeric_limits<double>::min());
    EXPECT_EQ(exact.value(), std::numeric_limits<double>::min() + 1000 * tiniest);
}

TEST(ExactSum, BeyondTheLargestDouble) {
    constexpr double largest = std::numeric_limits<double>::max();
    EXPECT_EQ(sum({largest, largest}), std::numeric_limits<double>::infinity());
    EXPECT_EQ(sum({-largest, -largest}), -std::numeric_limits<double>::infinity());
    EXPECT_EQ(sum({largest, largest, -largest}), largest);
}

TEST(ExactSum, NotFiniteTermsShow) {
    EXPECT_TRUE(std::isnan(sum({1, std::numeric_limits<double>::infinity()})));
    EXPECT_TRUE(std::isnan(sum({std::numeric_limits<double>::quiet_NaN(), 1})));
    EXPECT_TRUE(
        std::isnan(sum({-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()})));
}

TEST(ExactSum, IntegersAddUpExactly) {
    constexpr RandomStream draws{.seed = 5};
    ExactSum exact;
    __extension__ using Wide = __int128;
    Wide expected = 0;
    for (std::uint64_t k = 0; k < 300000; ++k) {
        const double x = std::floor((draws.uniform(k, 0) - 0.6) * 0x1p52) * (k % 3 == 0 ? 1024 : 1);
        exact.add(x);
        expected += static_cast<Wide>(x);
    }
    EXPECT_LT(expected, 0);
    const auto nearest = static_cast<double>(expected);
    EXPECT_NEAR(exact.value(), nearest, std::abs(nearest) * 0x1p-52);
}

TEST(ExactSum, AgreesWithLongDouble) {
    constexpr RandomStream draws{.seed = 6};
    ExactSum exact;
    long double expected = 0;
    for (std::uint64_t k = 0; k < 100000; ++k) {
        const double x = draws.uniform(k, 0);
        exact.add(x);
        expected += static_cast<long double>(x);
    }
    EXPECT_NEAR(exact.value(), static_cast<double>(expected), 1e-11);
}

TEST(ExactSum, OrderDoesNotMatter) {
    constexpr RandomStream draws{.seed = 7};
    std::vector<double> terms;
    for (std::uint64_t k = 0; k < 3000; ++k) {
        const double x = (draws.uniform(k, 0) - 0.5) * std::exp2(2000 * (draws.uniform(k, 1) - 0.5));
        terms.push_back(x);
        if (k % 2 == 0) terms.push_back(-x);  // most of the large terms cancel
    }
    ExactSum forward;
    forward.add(terms);
    for (std::uint32_t shuffle = 0; shuffle < 5; ++shuffle) {
        std::vector<std::size_t> order(terms.size());
        for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
        std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return draws.uniform(a, 10 + shuffle) < draws.uniform(b, 10 + shuffle);
        });
        ExactSum shuffled;
        for (const std::size_t k : order) shuffled.add(terms[k]);
        EXPECT_EQ(shuffled.value(), forward.value());
    }
}

}  // namespace
}  // namespace talus
