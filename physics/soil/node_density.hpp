#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "domain/particles.hpp"
#include "domain/soil_fields.hpp"
#include "physics/soil/constitutive.hpp"

namespace talus::soil {

/// Density of nodes [kg/m3]: that of their body, or their mass over their volume if the set knows volumes, as
/// it does where bodies differ in density, for nodes between two of them have some of both.
class NodeDensity {
  public:
    NodeDensity(const ParticleSet& particles, std::span<const Material> materials)
        : materials_(materials),
          body_(particles.data(field::body)),
          mass_(particles.data(field::mass)),
          volume_(particles.has(soil_field::volume) ? particles.data(soil_field::volume) : nullptr) {}

    double operator[](std::size_t i) const {
        return volume_ ? mass_[i] / volume_[i] : materials_[body_[i]].density;
    }

  private:
    std::span<const Material> materials_;
    const std::uint8_t* body_;
    const double *mass_, *volume_;
};

}  // namespace talus::soil
