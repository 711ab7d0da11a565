#include "domain/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace talus {
namespace {

using Words = std::array<std::uint32_t, 4>;

// Known answers of the Random123 library, tests/kat_vectors, rows "philox4x32 10".
TEST(Random, PhiloxMatchesTheKnownAnswers) {
    EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
    constexpr std::uint32_t ones = 0xffffffff;
    EXPECT_EQ(philox4x32({ones, ones, ones, ones}, {ones, ones}),
              (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
    EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
              (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Random, UniformHasTheMomentsOfUniform) {
    const RandomStream stream{.seed = 7};
    constexpr int n = 200000;
    double sum = 0, squares = 0, product = 0;
    for (int i = 0; i < n; ++i) {
        const double x = stream.uniform(static_cast<std::uint64_t>(i), 0);
        const double y = stream.uniform(static_cast<std::uint64_t>(i), 1);
        ASSERT_GT(x, 0);
        ASSERT_LT(x, 1);
        sum += x - 0.5;
        squares += x * x;
        product += (x - 0.5) * (y - 0.5);
    }
    EXPECT_LT(std::abs(sum / n), 4 * std::sqrt(1.0 / 12 / n));
    EXPECT_LT(std::abs(squares / n - 1.0 / 3), 4 * std::sqrt(4.0 / 45 / n));
    EXPECT_LT(std::abs(product / n), 4 * std::sqrt(1.0 / 144 / n));
}

TEST(Random, EveryPartOfTheAddressMatters) {
    const RandomStream stream{.seed = 1, .purpose = RandomPurpose::flaws, .group = 2};
    const double x = stream.uniform(3, 4);
    EXPECT_EQ(x, stream.uniform(3, 4));
    EXPECT_NE(x, stream.uniform(4, 3));
    EXPECT_NE(x, stream.uniform(3 + (std::uint64_t{1} << 32), 4));
    EXPECT_NE(x, (RandomStream{2, RandomPurpose::flaws, 2}.uniform(3, 4)));
    EXPECT_NE(x, (RandomStream{1 + (std::uint64_t{1} << 32), RandomPurpose::flaws, 2}.uniform(3, 4)));
    EXPECT_NE(x, (RandomStream{1, RandomPurpose::positions, 2}.uniform(3, 4)));
    EXPECT_NE(x, (RandomStream{1, RandomPurpose::flaws, 3}.uniform(3, 4)));
}

}  // namespace
}  // namespace talus
