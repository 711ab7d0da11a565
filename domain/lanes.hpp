#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <experimental/simd>
#ifdef __AVX2__
#include <immintrin.h>
#endif

namespace talus {

/// Four doubles that a pair loop works on at once: four partners of one particle. Always four, so that sums
/// over partners have the same bits on every processor.
inline constexpr std::size_t lane_count = 4;
using Lanes = std::experimental::simd<double, std::experimental::simd_abi::deduce_t<double, lane_count>>;
using LaneMask = Lanes::mask_type;

/// Choice per lane; with a bool and doubles the same formula serves scalars.
inline Lanes select(const LaneMask& condition, const Lanes& yes, const Lanes& no) {
    Lanes chosen = no;
    where(condition, chosen) = yes;
    return chosen;
}
inline double select(bool condition, double yes, double no) { return condition ? yes : no; }

/// Sum over lanes in a fixed order.
inline double sum(const Lanes& v) { return (v[0] + v[1]) + (v[2] + v[3]); }

/// True in the first `count` lanes.
inline LaneMask first_lanes(std::size_t count) {
    return Lanes([](auto lane) { return static_cast<double>(lane); }) <
           static_cast<double>(static_cast<std::int64_t>(count));
}

inline Lanes load(const double* from) { return Lanes(from, std::experimental::element_aligned); }

/// Two neighbouring values of four records: the first of each in the lanes of `first`, and so on.
inline void load_two(const std::array<const double*, lane_count>& records, Lanes& first, Lanes& second) {
#ifdef __AVX2__
    const auto halves = [](const double* low, const double* high) {
        return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(low)), _mm_loadu_pd(high), 1);
    };
    const __m256d even = halves(records[0], records[2]), odd = halves(records[1], records[3]);
    first = Lanes(_mm256_unpacklo_pd(even, odd));
    second = Lanes(_mm256_unpackhi_pd(even, odd));
#else
    first = Lanes([&](auto lane) { return records[lane][0]; });
    second = Lanes([&](auto lane) { return records[lane][1]; });
#endif
}

/// Stores those of `from[0..3]` whose lane of `sign` is negative one after the other, and returns how many
/// they are. All four places at `to` may be written.
inline std::size_t keep_negative(const Lanes& sign, const std::uint32_t* from, std::uint32_t* to) {
#ifdef __AVX2__
    struct Shuffles {
        alignas(16) std::array<std::array<std::uint8_t, 16>, 16> bytes{};
        constexpr Shuffles() {
            for (std::size_t mask = 0; mask < 16; ++mask) {
                std::size_t place = 0;
                for (std::size_t lane = 0; lane < lane_count; ++lane) {
                    if (!(mask >> lane & 1)) continue;
                    for (std::size_t b = 0; b < 4; ++b)
                        bytes[mask][place++] = static_cast<std::uint8_t>(4 * lane + b);
                }
            }
        }
    };
    static constexpr Shuffles shuffles;
    const auto mask = static_cast<unsigned>(_mm256_movemask_pd(static_cast<__m256d>(sign)));
    const __m128i values = _mm_loadu_si128(reinterpret_cast<const __m128i*>(from));
    const __m128i order = _mm_load_si128(reinterpret_cast<const __m128i*>(shuffles.bytes[mask].data()));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(to), _mm_shuffle_epi8(values, order));
    return static_cast<std::size_t>(_mm_popcnt_u32(mask));
#else
    std::size_t count = 0;
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
        to[count] = from[lane];
        count += sign[lane] < 0 ? 1 : 0;
    }
    return count;
#endif
}

}  // namespace talus
