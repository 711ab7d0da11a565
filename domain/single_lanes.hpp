#pragma once
#include "domain/lanes.hpp"

namespace talus {

/// Sixteen floats with AVX-512, else eight; formulas written for double lanes take them: constants are
/// rounded to float.
class SingleLanes {
  public:
    static constexpr std::size_t size() { return 2 * lane_count; }
    static constexpr std::size_t count = 2 * lane_count;
    using Values = std::experimental::simd<float, std::experimental::simd_abi::deduce_t<float, count>>;
    using Mask = Values::mask_type;

    SingleLanes() = default;
    SingleLanes(double value) : values_(static_cast<float>(value)) {}
    explicit SingleLanes(const Values& values) : values_(values) {}
    /// Two sets of double lanes, rounded.
    SingleLanes(const Lanes& low, const Lanes& high);

    const Values& values() const { return values_; }

    SingleLanes operator-() const { return SingleLanes(-values_); }
    friend SingleLanes operator+(const SingleLanes& a, const SingleLanes& b) {
        return SingleLanes(a.values_ + b.values_);
    }
    friend SingleLanes operator-(const SingleLanes& a, const SingleLanes& b) {
        return SingleLanes(a.values_ - b.values_);
    }
    friend SingleLanes operator*(const SingleLanes& a, const SingleLanes& b) {
        return SingleLanes(a.values_ * b.values_);
    }
    friend SingleLanes operator/(const SingleLanes& a, const SingleLanes& b) {
        return SingleLanes(a.values_ / b.values_);
    }
    SingleLanes& operator+=(const SingleLanes& b) { return *this = *this + b; }
    SingleLanes& operator*=(const SingleLanes& b) { return *this = *this * b; }
    friend Mask operator<(const SingleLanes& a, const SingleLanes& b) { return a.values_ < b.values_; }
    friend Mask operator>(const SingleLanes& a, const SingleLanes& b) { return a.values_ > b.values_; }
    friend Mask operator!=(const SingleLanes& a, const SingleLanes& b) { return a.values_ != b.values_; }
    friend SingleLanes max(const SingleLanes& a, const SingleLanes& b) {
        return SingleLanes(std::experimental::max(a.values_, b.values_));
    }
    friend SingleLanes min(const SingleLanes& a, const SingleLanes& b) {
        return SingleLanes(std::experimental::min(a.values_, b.values_));
    }
    friend SingleLanes sqrt(const SingleLanes& a) { return SingleLanes(std::experimental::sqrt(a.values_)); }
    friend SingleLanes abs(const SingleLanes& a) { return SingleLanes(std::experimental::abs(a.values_)); }
    friend SingleLanes select(const Mask& condition, const SingleLanes& yes, const SingleLanes& no) {
        Values chosen = no.values_;
        where(condition, chosen) = yes.values_;
        return SingleLanes(chosen);
    }

  private:
    Values values_;
};

inline SingleLanes::SingleLanes(const Lanes& low, const Lanes& high) {
#ifdef __AVX512VL__
    values_ = Values(_mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps(static_cast<__m512d>(low))),
                                        _mm512_cvtpd_ps(static_cast<__m512d>(high)), 1));
#else
    values_ = Values([&](auto lane) {
        return static_cast<float>(lane < lane_count ? low[lane] : high[lane - lane_count]);
    });
#endif
}

/// True in the first `count` lanes.
inline SingleLanes::Mask first_single(std::size_t count) {
    return SingleLanes::Values([](auto lane) { return static_cast<float>(lane); }) <
           static_cast<float>(static_cast<std::int64_t>(count));
}

template <class Real>
auto first(std::size_t count) {
    if constexpr (std::is_same_v<Real, Lanes>)
        return first_lanes(count);
    else
        return first_single(count);
}

/// As LaneSum in sixteen partial sums of floats, which are added in double.
class SingleSum {
  public:
    void add(std::size_t k, const SingleLanes& terms) {
        parts_[k / SingleLanes::count % parts_.size()] += terms;
    }
    double total() const {
        std::array<float, 16> parts;
        for (std::size_t p = 0; p < parts_.size(); ++p)
            parts_[p].values().copy_to(parts.data() + p * SingleLanes::count,
                                       std::experimental::element_aligned);
        std::array<double, 8> sums;
        for (std::size_t k = 0; k < 8; ++k) sums[k] = static_cast<double>(parts[k]) + parts[k + 8];
        for (std::size_t k = 0; k < 4; ++k) sums[k] += sums[k + 4];
        return (sums[0] + sums[1]) + (sums[2] + sums[3]);
    }

  private:
    std::array<SingleLanes, 16 / SingleLanes::count> parts_ = [] {
        std::array<SingleLanes, 16 / SingleLanes::count> zeros;
        zeros.fill(0.0);
        return zeros;
    }();
};

/// As SingleSum, each term added in double.
class WideSum {
  public:
    void add(std::size_t, const SingleLanes& terms) {
#ifdef __AVX512VL__
        const auto values = static_cast<__m512>(terms.values());
        low_ += Lanes(_mm512_cvtps_pd(_mm512_castps512_ps256(values)));
        high_ += Lanes(_mm512_cvtps_pd(_mm512_extractf32x8_ps(values, 1)));
#else
        low_ += Lanes([&](auto lane) -> double { return terms.values()[lane]; });
        high_ += Lanes([&](auto lane) -> double { return terms.values()[lane + lane_count]; });
#endif
    }
    double total() const {
        const Lanes sum = low_ + high_;
        std::array<double, lane_count> parts;
        sum.copy_to(parts.data(), std::experimental::element_aligned);
        double total = 0;
        for (const double part : parts) total += part;
        return total;
    }

  private:
    Lanes low_ = 0, high_ = 0;
};

/// Values `c` to `c` + 3 of as many records as there are single lanes.
inline void load_four(const std::array<const float*, SingleLanes::count>& records, std::size_t c,
                      SingleLanes* to) {
#ifdef __AVX512VL__
    const auto quads = [&](std::size_t q) {
        __m512 v = _mm512_castps128_ps512(_mm_load_ps(records[q] + c));
        v = _mm512_insertf32x4(v, _mm_load_ps(records[q + 4] + c), 1);
        v = _mm512_insertf32x4(v, _mm_load_ps(records[q + 8] + c), 2);
        return _mm512_castps_pd(_mm512_insertf32x4(v, _mm_load_ps(records[q + 12] + c), 3));
    };
    const __m512 v0 = _mm512_castpd_ps(quads(0)), v1 = _mm512_castpd_ps(quads(1)),
                 v2 = _mm512_castpd_ps(quads(2)), v3 = _mm512_castpd_ps(quads(3));
    const __m512d t0 = _mm512_castps_pd(_mm512_unpacklo_ps(v0, v1)),
                  t1 = _mm512_castps_pd(_mm512_unpackhi_ps(v0, v1)),
                  t2 = _mm512_castps_pd(_mm512_unpacklo_ps(v2, v3)),
                  t3 = _mm512_castps_pd(_mm512_unpackhi_ps(v2, v3));
    const auto lanes = [](__m512d v) { return SingleLanes(SingleLanes::Values(_mm512_castpd_ps(v))); };
    to[0] = lanes(_mm512_unpacklo_pd(t0, t2));
    to[1] = lanes(_mm512_unpackhi_pd(t0, t2));
    to[2] = lanes(_mm512_unpacklo_pd(t1, t3));
    to[3] = lanes(_mm512_unpackhi_pd(t1, t3));
#else
    for (std::size_t k = 0; k < 4; ++k)
        to[k] = SingleLanes(SingleLanes::Values([&](auto lane) { return records[lane][c + k]; }));
#endif
}

/// Values of as many records as there are double lanes, rounded, to `c` to `c` + 3 of each.
inline void store_four(const std::array<float*, lane_count>& records, std::size_t c, const Lanes* from) {
#ifdef __AVX512VL__
    const auto rounded = [&](std::size_t k) { return _mm512_cvtpd_ps(static_cast<__m512d>(from[k])); };
    const __m256 v0 = rounded(0), v1 = rounded(1), v2 = rounded(2), v3 = rounded(3);
    const __m256d t0 = _mm256_castps_pd(_mm256_unpacklo_ps(v0, v1)),
                  t1 = _mm256_castps_pd(_mm256_unpackhi_ps(v0, v1)),
                  t2 = _mm256_castps_pd(_mm256_unpacklo_ps(v2, v3)),
                  t3 = _mm256_castps_pd(_mm256_unpackhi_ps(v2, v3));
    const auto put = [&](__m256d v, std::size_t q) {
        _mm_store_ps(records[q] + c, _mm_castpd_ps(_mm256_castpd256_pd128(v)));
        _mm_store_ps(records[q + 4] + c, _mm_castpd_ps(_mm256_extractf128_pd(v, 1)));
    };
    put(_mm256_unpacklo_pd(t0, t2), 0);
    put(_mm256_unpackhi_pd(t0, t2), 1);
    put(_mm256_unpacklo_pd(t1, t3), 2);
    put(_mm256_unpackhi_pd(t1, t3), 3);
#else
    for (std::size_t lane = 0; lane < lane_count; ++lane)
        for (std::size_t k = 0; k < 4; ++k) records[lane][c + k] = static_cast<float>(from[k][lane]);
#endif
}

}  // namespace talus
