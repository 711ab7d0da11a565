#pragma once
#include <cstdint>
#include <span>

#include "domain/cell_table.hpp"
#include "domain/particles.hpp"
#include "physics/water/settings.hpp"

namespace talus::water {

/// wall_force of own wall particles of the bodies that ask for it: what the water feels from each of them in
/// force_pass(), with the sign changed, pair by pair and to single rounding. `feels`: one a body, not 0 if
/// its particles ask. After force_pass(), while the copies of partners are fresh; reads position, body and
/// partner_*.
void find_wall_forces(ParticleSet& particles, const CellTable& table, const Settings& settings,
                      std::span<const std::uint8_t> feels);

}  // namespace talus::water
