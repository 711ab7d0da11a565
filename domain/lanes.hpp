#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <experimental/simd>
#ifdef __AVX2__
#include <immintrin.h>
#endif
#if defined(__clang__) && defined(__AVX512VL__) && defined(__GLIBCXX__)
#error \
    "libstdc++'s simd chooses all lanes alike with clang and AVX-512 (_S_blend_avx512 of version 12): -DTALUS_ARCH=x86-64-v3"
#endif

namespace talus {

/// The doubles that a pair loop works on at once, several partners of one particle: as many as the processor
/// has registers for. What LaneSum adds up does not depend on it.
#ifdef __AVX512VL__
inline constexpr std::size_t lane_count = 8;
#else
inline constexpr std::size_t lane_count = 4;
#endif
using Lanes = std::experimental::simd<double, std::experimental::simd_abi::deduce_t<double, lane_count>>;
using LaneMask = Lanes::mask_type;

/// Choice per lane; with a bool and doubles the same formula serves scalars.
inline Lanes select(const LaneMask& condition, const Lanes& yes, const Lanes& no) {
    Lanes chosen = no;
    where(condition, chosen) = yes;
    return chosen;
}
inline double select(bool condition, double yes, double no) { return condition ? yes : no; }

/// A sum over partners in eight partial sums, partner k in the one of k mod 8, and of these in a fixed order:
/// the same bits on every processor. Partners are added in order, from 0 on.
class LaneSum {
  public:
    /// Adds the terms of partners k to k + lane_count - 1; zeros where there is none.
    void add(std::size_t k, const Lanes& terms) { parts_[k / lane_count % parts_.size()] += terms; }
    double total() const {
        constexpr std::size_t half = 4;
        std::array<double, 2 * half> parts;
        for (std::size_t p = 0; p < parts_.size(); ++p)
            parts_[p].copy_to(parts.data() + p * lane_count, std::experimental::element_aligned);
        for (std::size_t k = 0; k < half; ++k) parts[k] += parts[k + half];
        return (parts[0] + parts[1]) + (parts[2] + parts[3]);
    }

  private:
    std::array<Lanes, 8 / lane_count> parts_{};
};

/// True in the first `count` lanes.
inline LaneMask first_lanes(std::size_t count) {
    return Lanes([](auto lane) { return static_cast<double>(lane); }) <
           static_cast<double>(static_cast<std::int64_t>(count));
}

inline Lanes load(const double* from) { return Lanes(from, std::experimental::element_aligned); }

/// The first `count` of as many values as there are lanes, and zeros; no others are read.
inline Lanes load_first(const double* from, std::size_t count) {
    if (count >= lane_count) return load(from);
    Lanes values = 0;
    where(first_lanes(count), values).copy_from(from, std::experimental::element_aligned);
    return values;
}

/// Stores the first `count` lanes; no other values are written.
inline void store_first(double* to, std::size_t count, const Lanes& values) {
    if (count >= lane_count) return values.copy_to(to, std::experimental::element_aligned);
    where(first_lanes(count), values).copy_to(to, std::experimental::element_aligned);
}

/// Values `c` and `c` + 1 of as many records as there are lanes: the first of each in the lanes of `first`.
inline void load_two(const std::array<const double*, lane_count>& records, std::size_t c, Lanes& first,
                     Lanes& second) {
#ifdef __AVX2__
    const auto halves = [&](std::size_t low, std::size_t high) {
        return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(records[low] + c)),
                                    _mm_loadu_pd(records[high] + c), 1);
    };
#endif
#ifdef __AVX512VL__
    const auto joined = [](__m256d low, __m256d high) {
        return _mm512_insertf64x4(_mm512_castpd256_pd512(low), high, 1);
    };
    const __m512d even = joined(halves(0, 2), halves(4, 6)), odd = joined(halves(1, 3), halves(5, 7));
    first = Lanes(_mm512_unpacklo_pd(even, odd));
    second = Lanes(_mm512_unpackhi_pd(even, odd));
#elif defined(__AVX2__)
    const __m256d even = halves(0, 2), odd = halves(1, 3);
    first = Lanes(_mm256_unpacklo_pd(even, odd));
    second = Lanes(_mm256_unpackhi_pd(even, odd));
#else
    first = Lanes([&](auto lane) { return records[lane][c]; });
    second = Lanes([&](auto lane) { return records[lane][c + 1]; });
#endif
}

/// The reverse of load_two().
inline void store_two(const std::array<double*, lane_count>& records, std::size_t c, const Lanes& first,
                      const Lanes& second) {
#if defined(__AVX2__)
    const auto store_halves = [&](const __m256d& pairs, std::size_t low, std::size_t high) {
        _mm_storeu_pd(records[low] + c, _mm256_castpd256_pd128(pairs));
        _mm_storeu_pd(records[high] + c, _mm256_extractf128_pd(pairs, 1));
    };
#endif
#ifdef __AVX512VL__
    const __m512d even = _mm512_unpacklo_pd(static_cast<__m512d>(first), static_cast<__m512d>(second)),
                  odd = _mm512_unpackhi_pd(static_cast<__m512d>(first), static_cast<__m512d>(second));
    store_halves(_mm512_castpd512_pd256(even), 0, 2);
    store_halves(_mm512_extractf64x4_pd(even, 1), 4, 6);
    store_halves(_mm512_castpd512_pd256(odd), 1, 3);
    store_halves(_mm512_extractf64x4_pd(odd, 1), 5, 7);
#elif defined(__AVX2__)
    store_halves(_mm256_unpacklo_pd(static_cast<__m256d>(first), static_cast<__m256d>(second)), 0, 2);
    store_halves(_mm256_unpackhi_pd(static_cast<__m256d>(first), static_cast<__m256d>(second)), 1, 3);
#else
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
        records[lane][c] = first[lane];
        records[lane][c + 1] = second[lane];
    }
#endif
}

/// Whole numbers in lanes.
using IntegerLanes = std::experimental::rebind_simd_t<std::int64_t, Lanes>;

/// Adds to values `c` and `c` + 1 of as many records as there are lanes, one after the other: a record may be
/// there more than once. Values 0 and 2 of a record are aligned to 16 bytes, `c` is even.
inline void add_two(const std::array<std::int64_t*, lane_count>& records, std::size_t c,
                    const IntegerLanes& first, const IntegerLanes& second) {
#ifdef __AVX2__
    const auto add = [&](std::size_t lane, __m128i values) {
        auto* at = reinterpret_cast<__m128i*>(records[lane] + c);
        _mm_store_si128(at, _mm_add_epi64(_mm_load_si128(at), values));
    };
#endif
#ifdef __AVX512VL__
    const auto a = static_cast<__m512i>(first), b = static_cast<__m512i>(second);
    const __m512i even = _mm512_unpacklo_epi64(a, b), odd = _mm512_unpackhi_epi64(a, b);
    add(0, _mm512_castsi512_si128(even));
    add(1, _mm512_castsi512_si128(odd));
    add(2, _mm512_extracti64x2_epi64(even, 1));
    add(3, _mm512_extracti64x2_epi64(odd, 1));
    add(4, _mm512_extracti64x2_epi64(even, 2));
    add(5, _mm512_extracti64x2_epi64(odd, 2));
    add(6, _mm512_extracti64x2_epi64(even, 3));
    add(7, _mm512_extracti64x2_epi64(odd, 3));
#elif defined(__AVX2__)
    const auto a = static_cast<__m256i>(first), b = static_cast<__m256i>(second);
    const __m256i even = _mm256_unpacklo_epi64(a, b), odd = _mm256_unpackhi_epi64(a, b);
    add(0, _mm256_castsi256_si128(even));
    add(1, _mm256_castsi256_si128(odd));
    add(2, _mm256_extracti128_si256(even, 1));
    add(3, _mm256_extracti128_si256(odd, 1));
#else
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
        records[lane][c] += first[lane];
        records[lane][c + 1] += second[lane];
    }
#endif
}

/// Stores those of `from` whose lane of `sign` is negative one after the other, and returns how many
/// they are. All places of a set of lanes at `to` may be written.
inline std::size_t keep_negative(const Lanes& sign, const std::uint32_t* from, std::uint32_t* to) {
#ifdef __AVX512VL__
    const __mmask8 mask = _mm512_cmp_pd_mask(static_cast<__m512d>(sign), _mm512_setzero_pd(), _CMP_LT_OQ);
    const __m256i values = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_maskz_compress_epi32(mask, values));
    return static_cast<std::size_t>(_mm_popcnt_u32(mask));
#elif defined(__AVX2__)
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
