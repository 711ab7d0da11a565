#pragma once
#include <array>
#include <cstdint>

namespace talus {

/// Philox4x32-10: 128 random bits from a counter and a key, with no state between calls.
/// J. K. Salmon, M. A. Moraes, R. O. Dror, D. E. Shaw, Proc. SC'11 (2011), section 3.3.
constexpr std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                                  std::array<std::uint32_t, 2> key) {
    for (int round = 0; round < 10; ++round) {
        const std::uint64_t product0 = std::uint64_t{0xD2511F53u} * counter[0];
        const std::uint64_t product1 = std::uint64_t{0xCD9E8D57u} * counter[2];
        counter = {static_cast<std::uint32_t>(product1 >> 32) ^ counter[1] ^ key[0],
                   static_cast<std::uint32_t>(product1),
                   static_cast<std::uint32_t>(product0 >> 32) ^ counter[3] ^ key[1],
                   static_cast<std::uint32_t>(product0)};
        key[0] += 0x9E3779B9u;
        key[1] += 0xBB67AE85u;
    }
    return counter;
}

/// What random numbers are drawn for; different purposes of one seed never share a number.
enum class RandomPurpose : std::uint16_t {
    test = 0,
    flaws = 1,
    positions = 2,
    velocities = 3,
    glass = 4,
    sources = 5
};

/// Random numbers addressed by (particle id, counter): the same whoever asks, in whichever order.
struct RandomStream {
    std::uint64_t seed = 0;                       ///< of the scene
    RandomPurpose purpose = RandomPurpose::test;  ///< what for
    std::uint16_t group = 0;                      ///< a further division, such as the index of the body

    /// Uniform in (0, 1), both ends excluded; 52 random bits.
    constexpr double uniform(std::uint64_t id, std::uint32_t counter) const {
        const auto words =
            philox4x32({static_cast<std::uint32_t>(id), static_cast<std::uint32_t>(id >> 32), counter,
                        static_cast<std::uint32_t>(purpose) << 16 | std::uint32_t{group}},
                       {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)});
        const std::uint64_t bits = std::uint64_t{words[0]} << 20 | words[1] >> 12;
        return (static_cast<double>(bits) + 0.5) * 0x1p-52;
    }
};

}  // namespace talus
