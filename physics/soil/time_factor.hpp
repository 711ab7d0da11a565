#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace talus::soil {

/// How a load, a velocity, gravity or the strength changes with time: straight lines between given points,
/// constant before and after them, times a harmonic if a frequency is given.
struct TimeFactor {
    std::vector<double> times{};   ///< rising [s]; none: the factor is 1
    std::vector<double> values{};  ///< one a time [1]
    double frequency = 0;          ///< [Hz]
    double phase = 0;              ///< [rad]: cos(2 pi frequency t + phase)

    double operator()(double time) const {
        const double harmonic = frequency > 0 ? std::cos(2 * std::numbers::pi * frequency * time + phase) : 1;
        if (times.empty()) return harmonic;
        const auto after = std::upper_bound(times.begin(), times.end(), time);
        if (after == times.begin()) return values.front() * harmonic;
        if (after == times.end()) return values.back() * harmonic;
        const auto k = static_cast<std::size_t>(after - times.begin());
        const double share = (time - times[k - 1]) / (times[k] - times[k - 1]);
        return (values[k - 1] + share * (values[k] - values[k - 1])) * harmonic;
    }
};

}  // namespace talus::soil
