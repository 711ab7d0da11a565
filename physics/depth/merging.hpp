#pragma once
#include <cstdint>
#include <vector>

#include "domain/cell_table.hpp"
#include "domain/particles.hpp"
#include "physics/depth/settings.hpp"

/// Columns that have come close become one: where a flow is driven together it needs no more columns than
/// its depth gives sense to, and their smoothing length, which limits the time step, falls no further.
namespace talus::depth {

/// The nearest other column of each own one, the one with the lesser id of two that are as near: its index,
/// the own if there is none within the merging distance. Both must stand more densely than at that distance.
/// Sets nearest_column. Reads position, smoothing_length and known_id of partners.
std::vector<std::uint32_t> find_nearest(ParticleSet& particles, const CellTable& table,
                                        const Settings& settings);

/// Of two columns that are each other's nearest the one with the lesser id takes over the volume of both, at
/// their centre and with their momentum in plan. Lists the own columns that remain, in order. Reads
/// nearest_column, position, volume and predicted_velocity of partners, the last being their velocity now.
std::vector<std::uint32_t> merge(ParticleSet& particles, const std::vector<std::uint32_t>& nearest);

}  // namespace talus::depth
