#pragma once
#include <cmath>
#include <cstdint>

namespace talus::dem {

/// Forces and torques on a grain, added up in whole numbers of a unit of its own, so that the order of
/// contacts does not matter. A force on a pair is cut towards zero: exactly opposite on grains of one unit.
struct alignas(16) ForceSum {
    std::int64_t force[3], torque[3];
};

/// The greatest force of one contact is 2^57 units: so many may act together, and what is cut off is 1e-17
/// of it.
inline constexpr double most_units = 0x1p57;

/// Unit of force of a grain on which no contact acts with more than `greatest_force`: a power of two [N].
inline double force_unit(double greatest_force) {
    int exponent = 0;
    std::frexp(greatest_force, &exponent);
    return std::ldexp(1.0, exponent) / most_units;
}

}  // namespace talus::dem
