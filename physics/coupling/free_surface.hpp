#pragma once
#include "domain/cell_table.hpp"
#include "domain/particles.hpp"

namespace talus::coupling {

/// How full the surroundings of a fluid particle are, sum_b V_b w_ab over fluid and walls: 1 within even
/// fluid, about 0.7 in the first layer at a free surface.
struct Fullness {
    static constexpr double surface = 0.85;  ///< less than this is at a free surface
    static constexpr double drop = 0.5;      ///< less than this is a drop, alone
};

/// Grains that leave a fluid particle, or come to it, change the room that its water has. Within the fluid,
/// the water around makes up for that; at a free surface air does. So a particle there that is under tension,
/// and a drop at any pressure, gets the density of fluid without pressure: its mass stays, its volume in
/// space becomes what that mass and the grains need. Sums over |quadrature_volume|, which is negative where a
/// wall is, over all within `radius`. Reads density, mass and solid_fraction. The same bits on any number of
/// ranks.
void relieve_free_surface(ParticleSet& fluid, const CellTable& cells, double radius, double rest_density);

}  // namespace talus::coupling
