#pragma once
#include <bit>
#include <cmath>
#include <cstdint>

#include "physics/dem/vector3.hpp"

namespace talus::dem {

/// Forces and torques on a grain, added up in whole numbers of a unit of its own, so that the order of
/// contacts does not matter. A force on a pair is cut towards zero: exactly opposite on grains of one unit.
struct alignas(16) ForceSum {
    std::int64_t force[3], torque[3];
};

/// What follows from the sums takes their place until the next ones are begun: accelerations [m s-2] and
/// angular accelerations [rad s-2].
struct Rates {
    double acceleration[3], angular_acceleration[3];
};
inline Rates rates_in(const ForceSum& sum) { return std::bit_cast<Rates>(sum); }
inline ForceSum in_place_of_sum(const Rates& rates) { return std::bit_cast<ForceSum>(rates); }

/// The greatest force of one contact is 2^57 units: so many may act together, and what is cut off is 1e-17
/// of it.
inline constexpr double most_units = 0x1p57;

/// Unit of force of a grain on which no contact acts with more than `greatest_force`: a power of two [N].
inline double force_unit(double greatest_force) {
    int exponent = 0;
    std::frexp(greatest_force, &exponent);
    return std::ldexp(1.0, exponent) / most_units;
}

/// Adds a vector in whole units; false, with nothing for a component that is beyond `most_units`.
inline bool add_in_units(const Vector3<>& vector, double units_per_force, std::int64_t* sum) {
    bool bearable = true;
    for (const double component : {vector.x, vector.y, vector.z}) {
        const double scaled = component * units_per_force;
        const bool within = std::abs(scaled) < most_units;
        *sum++ += within ? static_cast<std::int64_t>(scaled) : 0;
        bearable = bearable && within;
    }
    return bearable;
}

}  // namespace talus::dem
