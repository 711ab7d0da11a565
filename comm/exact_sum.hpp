#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "comm/communicator.hpp"

namespace talus {

/// Sum of doubles without any rounding until its value is asked for, so that the order of additions and
/// the number of ranks do not matter: a fixed-point number wide enough for every double.
/// U. Kulisch, Computer Arithmetic and Validity (2013), ch. 8; here with 32-bit digits in 64-bit words.
class ExactSum {
  public:
    void add(double value);
    void add(std::span<const double> values) {
        for (const double value : values) add(value);
    }
    /// The sum, correct to one unit in the last place; NaN if any value added was not finite.
    double value() const;

    /// Adds up the sums of all ranks, element by element: every rank gets the totals. Collective.
    static void all_reduce(const Communicator& comm, std::span<ExactSum> sums);

  private:
    static constexpr std::size_t digit_count = 69;  // 2^-1074 to beyond 2^1024 * 2^64
    void propagate_carries();

    std::array<std::int64_t, digit_count> digits_{};
    std::int64_t not_finite_ = 0;
    std::uint32_t additions_ = 0;
};

}  // namespace talus
