#pragma once
#include <filesystem>
#include <optional>

#include "comm/communicator.hpp"
#include "domain/particles.hpp"
#include "io/scene.hpp"

namespace talus {

/// The file that a table of grains names, if it is one of particle sets: one that ends in .h5, or a folder,
/// which means the newest checkpoint in it. Nothing if it is a list of rows. Collective.
std::optional<std::filesystem::path> file_of_grains(const Communicator& comm, const Scene& scene,
                                                    const Section& table);

/// The grains of a file written at a hand-off or by a run of grains, each rank its share: id, position,
/// velocity, mass, radius, angular velocity and body; those of body `of_body` alone, if the table says so.
/// None if the file cannot be read, which is recorded in the scene. Collective.
ParticleSet read_grains(const Communicator& comm, const std::filesystem::path& file, const Section& table);

/// Appends the grains with the fields they have, their ids counted on from `first_id`.
void append_grains(const ParticleSet& from, std::uint64_t first_id, std::uint8_t body, ParticleSet& grains);

/// Adds the motion of a solid body that turns about the centre of mass of grains [begin, end) of all ranks:
/// velocities and each grain's own spin. Collective.
void turn_grains(const Communicator& comm, const std::array<double, 3>& spin, std::size_t begin,
                 ParticleSet& grains);

}  // namespace talus
