#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "src/setup/coupled_scene.hpp"

namespace talus::test {

/// A scene with some keys set. Collective.
CoupledScene coupled_scene(const Communicator& comm, const std::filesystem::path& scene,
                           const std::vector<std::string>& overrides);

/// Runs a scene of water and grains to its end as the program does, without writing files; calls
/// after(simulation) at the start and after each step. Collective.
void run_coupled(const Communicator& comm, const CoupledScene& scene,
                 const std::function<void(const CoupledSimulation&)>& after);

}  // namespace talus::test
