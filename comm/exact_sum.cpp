#include "comm/exact_sum.hpp"

#include <bit>
#include <cmath>
#include <limits>

namespace talus {

namespace {
constexpr std::int64_t base = std::int64_t{1} << 32;
}

void ExactSum::add(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    const auto biased = static_cast<int>(bits >> 52 & 0x7ff);
    if (biased == 0x7ff) {
        ++not_finite_;
        return;
    }
    const std::uint64_t fraction = bits & 0xfffffffffffffu;
    const std::uint64_t mantissa = biased == 0 ? fraction : fraction | 0x10000000000000u;
    const int exponent = biased == 0 ? 0 : biased - 1;  // value = mantissa * 2^(exponent - 1074)
    const auto digit = static_cast<std::size_t>(exponent / 32);
    const int shift = exponent % 32;
    const std::uint64_t low = (mantissa & 0xffffffffu) << shift, high = (mantissa >> 32) << shift;
    const std::int64_t parts[3] = {static_cast<std::int64_t>(low & 0xffffffffu),
                                   static_cast<std::int64_t>((low >> 32) + (high & 0xffffffffu)),
                                   static_cast<std::int64_t>(high >> 32)};
    const std::int64_t sign = bits >> 63 ? -1 : 1;
    for (std::size_t k = 0; k < 3; ++k) digits_[digit + k] += sign * parts[k];
    if (++additions_ == (1u << 29)) propagate_carries();
}

void ExactSum::propagate_carries() {
    additions_ = 0;
    std::int64_t carry = 0;
    for (std::size_t k = 0; k + 1 < digit_count; ++k) {
        const std::int64_t total = digits_[k] + carry;
        carry = total >> 32;  // rounds down, also for negative totals
        digits_[k] = total - carry * base;
    }
    digits_[digit_count - 1] += carry;
}

double ExactSum::value() const {
    if (not_finite_ != 0) return std::numeric_limits<double>::quiet_NaN();
    ExactSum sum = *this;
    sum.propagate_carries();
    const bool negative = sum.digits_[digit_count - 1] < 0;
    if (negative) {
        for (std::int64_t& digit : sum.digits_) digit = -digit;
        sum.propagate_carries();
    }
    std::size_t top = digit_count;
    while (top > 0 && sum.digits_[top - 1] == 0) --top;
    double result = 0;
    for (std::size_t k = top, used = 0; k > 0 && used < 4; --k, ++used)
        result += std::ldexp(static_cast<double>(sum.digits_[k - 1]), static_cast<int>(k - 1) * 32 - 1074);
    return negative ? -result : result;
}

void ExactSum::all_reduce(const Communicator& comm, std::span<ExactSum> sums) {
    std::vector<std::int64_t> words;
    words.reserve(sums.size() * (digit_count + 1));
    for (ExactSum& sum : sums) {
        sum.propagate_carries();
        words.insert(words.end(), sum.digits_.begin(), sum.digits_.end());
        words.push_back(sum.not_finite_);
    }
    comm.all_sum(std::span<std::int64_t>(words));
    auto word = words.begin();
    for (ExactSum& sum : sums) {
        for (std::int64_t& digit : sum.digits_) digit = *word++;
        sum.not_finite_ = *word++;
    }
}

}  // namespace talus
