#pragma once
#include <functional>

namespace talus::test {

/// Where the growing function f passes zero in [low, high].
inline double root_of(const std::function<double(double)>& f, double low, double high) {
    for (int k = 0; k < 100; ++k) {
        const double middle = 0.5 * (low + high);
        (f(middle) < 0 ? low : high) = middle;
    }
    return low;
}

}  // namespace talus::test
