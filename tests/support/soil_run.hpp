#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "src/setup/soil_scene.hpp"

namespace talus::test {

/// A scene with some keys set. Collective.
SoilScene soil_scene(const Communicator& comm, const std::filesystem::path& scene,
                     const std::vector<std::string>& overrides, bool quick = false);

/// Runs a scene of soil to its end as the program does, without writing files; calls after(simulation) at the
/// start and after each step. Collective.
void run_soil(const Communicator& comm, const SoilScene& scene,
              const std::function<void(const SoilSimulation&)>& after);

/// Nodes of this rank in no order: their indices.
std::vector<std::size_t> soil_nodes(const ParticleSet& particles);

}  // namespace talus::test
