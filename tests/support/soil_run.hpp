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

/// Of a sample with a weak spot (runs/shear_band): angle of the band between that and the other side to the
/// direction of the lateral, lesser stress, in degrees: of a line through the viscoplastic strain.
/// Collective.
double band_angle(const Communicator& comm, const SoilSimulation& simulation);

}  // namespace talus::test
