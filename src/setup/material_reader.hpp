#pragma once
#include <filesystem>
#include <string>

#include "comm/communicator.hpp"
#include "io/scene.hpp"
#include "physics/solid/material.hpp"

namespace talus {

/// A file's text, read by the root and handed to every rank. Throws SceneError on every rank if it cannot be
/// read. Collective.
std::string read_shared_text(const Communicator& comm, const std::filesystem::path& file);

/// A material from its table; keys in runs/materials/README.md. Faults are recorded in the table's scene.
Material read_material(const Section& table, const std::string& name, int dimension);

/// The material that a body's key `material` names: the scene's table [materials.NAME] if there is one, else
/// the file materials/NAME.toml in the scene's folder or the nearest one above it. Throws SceneError for
/// faults in such a file. Collective.
Material find_material(const Communicator& comm, const Scene& scene, const Section& body, int dimension);

}  // namespace talus
