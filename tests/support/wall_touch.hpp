#pragma once
#include <gtest/gtest.h>

#include <vector>

#include "domain/random.hpp"
#include "physics/dem/walls/shapes.hpp"

namespace talus::dem {

/// Numbers and vectors, one after the other.
class RandomValues {
  public:
    explicit RandomValues(std::uint64_t seed) : stream_{.seed = seed} {}
    double operator()(double low, double high) { return low + (high - low) * stream_.uniform(next_++, 0); }
    Vector3<> vector(double size) {
        return {(*this)(-size, size), (*this)(-size, size), (*this)(-size, size)};
    }

  private:
    RandomStream stream_;
    std::uint64_t next_ = 0;
};

template <class Shape>
std::vector<SurfaceContact> touch(const Shape& shape, const Vector3<>& centre, double reach) {
    std::vector<SurfaceContact> contacts;
    shape.find_contacts(centre, reach, contacts);
    return contacts;
}

inline void expect_near(const Vector3<>& a, const Vector3<>& b, double tolerance) {
    EXPECT_LE(norm(a - b), tolerance);
}

}  // namespace talus::dem
