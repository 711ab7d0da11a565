#pragma once
#include "domain/lanes.hpp"

namespace talus {

/// Floats that a pair loop works on at once, twice as many as doubles.
inline constexpr std::size_t float_lane_count = 2 * lane_count;
using FloatLanes =
    std::experimental::simd<float, std::experimental::simd_abi::deduce_t<float, float_lane_count>>;

inline FloatLanes load(const float* from) { return FloatLanes(from, std::experimental::element_aligned); }

/// The first `count` of as many values as there are lanes, and zeros; no others are read.
inline FloatLanes load_first(const float* from, std::size_t count) {
    if (count >= float_lane_count) return load(from);
#ifdef __AVX512VL__
    return FloatLanes(_mm512_maskz_loadu_ps(static_cast<__mmask16>((1U << count) - 1), from));
#else
    return FloatLanes([=](auto lane) { return lane < count ? from[lane] : 0.0F; });
#endif
}

/// A sum over partners in sixteen partial sums, partner k in the one of k mod 16, and of these in a fixed
/// order and in double: the same bits on every processor. Partners are added in order, from 0 on.
class FloatLaneSum {
  public:
    /// Adds the terms of partners k to k + float_lane_count - 1; zeros where there is none.
    void add(std::size_t k, const FloatLanes& terms) {
        parts_[k / float_lane_count % parts_.size()] += terms;
    }
    double total() const {
        std::array<float, part_count> parts;
        for (std::size_t p = 0; p < parts_.size(); ++p)
            parts_[p].copy_to(parts.data() + p * float_lane_count, std::experimental::element_aligned);
        std::array<double, part_count / 2> sums;
        for (std::size_t k = 0; k < sums.size(); ++k)
            sums[k] = static_cast<double>(parts[k]) + static_cast<double>(parts[k + sums.size()]);
        return ((sums[0] + sums[1]) + (sums[2] + sums[3])) + ((sums[4] + sums[5]) + (sums[6] + sums[7]));
    }

  private:
    static constexpr std::size_t part_count = 16;
    std::array<FloatLanes, part_count / float_lane_count> parts_{};
};

/// Which lanes, a bit each from the lowest on.
using LaneBits = std::uint32_t;

/// Those lanes of negative values.
inline LaneBits negative_lanes(const FloatLanes& values) {
#ifdef __AVX512VL__
    return _mm512_cmp_ps_mask(static_cast<__m512>(values), _mm512_setzero_ps(), _CMP_LT_OQ);
#else
    LaneBits bits = 0;
    for (std::size_t lane = 0; lane < float_lane_count; ++lane)
        bits |= LaneBits{values[lane] < 0 ? 1U : 0U} << lane;
    return bits;
#endif
}

/// Stores the lanes whose bit is set one after the other. All places of a set of lanes at `to` may be
/// written.
inline void store_lanes(LaneBits bits, const FloatLanes& values, float* to) {
#ifdef __AVX512VL__
    _mm512_storeu_ps(to, _mm512_maskz_compress_ps(static_cast<__mmask16>(bits), static_cast<__m512>(values)));
#else
    for (std::size_t lane = 0; lane < float_lane_count; ++lane) {
        *to = values[lane];
        to += bits >> lane & 1;
    }
#endif
}

/// Doubles as floats, two sets of lanes in one.
inline FloatLanes narrowed(const Lanes& low, const Lanes& high) {
#ifdef __AVX512VL__
    const __m256 first = _mm512_cvtpd_ps(static_cast<__m512d>(low)),
                 second = _mm512_cvtpd_ps(static_cast<__m512d>(high));
    return FloatLanes(_mm512_insertf32x8(_mm512_castps256_ps512(first), second, 1));
#else
    return FloatLanes([&](auto lane) {
        return static_cast<float>(lane < lane_count ? low[lane % lane_count] : high[lane % lane_count]);
    });
#endif
}

}  // namespace talus
