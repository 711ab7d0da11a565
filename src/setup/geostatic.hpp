#pragma once
#include <array>
#include <optional>

#include "io/scene.hpp"
#include "physics/solid/material.hpp"
#include "src/setup/bodies.hpp"

namespace talus {

/// The table [geostatic] of a body: it starts with the stress that its weight makes under a level surface.
/// None if there is no such table. Faults are recorded in the scene.
std::optional<GeostaticStart> read_geostatic(const Section& body, const Material& material,
                                             const std::optional<std::array<double, 3>>& gravity,
                                             const BodyShape& shape, int dimension);

/// Density and deviatoric stress of a particle that lies there, as far as the set has those fields, and the
/// mass that goes with the density: at the volume of the others, or sums over a lattice that is not
/// compressed would err by four times the strain.
void put_geostatic(ParticleSet& particles, std::size_t i, const GeostaticStart& start,
                   const Material& material);

}  // namespace talus
