#pragma once
#include <cstddef>
#include <type_traits>

#include "domain/particles.hpp"
#include "physics/dem/vector3.hpp"

namespace talus::dem {

/// A vector field of grains and copies, looked up once. `Set`: ParticleSet, or const ParticleSet to read
/// only.
template <class Set>
class Vectors {
  public:
    Vectors(Set& grains, const Field<double>& field)
        : x_(grains.data(field, 0)), y_(grains.data(field, 1)), z_(grains.data(field, 2)) {}
    Vector3<> operator[](std::size_t i) const { return {x_[i], y_[i], z_[i]}; }
    void put(std::size_t i, const Vector3<>& v) const requires(!std::is_const_v<Set>) {
        x_[i] = v.x;
        y_[i] = v.y;
        z_[i] = v.z;
    }

  private:
    using Value = std::conditional_t<std::is_const_v<Set>, const double, double>;
    Value *x_, *y_, *z_;
};

}  // namespace talus::dem
