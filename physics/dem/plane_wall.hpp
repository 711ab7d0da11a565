#pragma once
#include <cstdint>
#include <string>

#include "physics/dem/vector3.hpp"

namespace talus::dem {

/// A plane without an end that grains stay in front of.
struct PlaneWall {
    std::string name;
    Vector3<> point;        ///< on the plane [m]
    Vector3<> normal;       ///< unit vector, to the side of the grains
    std::uint8_t material;  ///< index

    double distance(const Vector3<>& position) const { return dot(position - point, normal); }
};

}  // namespace talus::dem
