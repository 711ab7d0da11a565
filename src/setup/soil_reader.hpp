#pragma once
#include <array>
#include <string_view>
#include <vector>

#include "io/scene.hpp"
#include "src/setup/soil_scene.hpp"

namespace talus {

/// Of soil::Face.
inline constexpr std::array<std::string_view, 6> face_names = {"x_lower", "x_upper", "y_lower",
                                                               "y_upper", "z_lower", "z_upper"};

// Parts of a scene of soil. Faults are recorded in the scene.

/// The material that a body's key `material` names, from the scene's table [materials.NAME], for what `setup`
/// says: with what water in pores needs, and no surface that cannot follow a change of strength.
soil::Material read_soil_material(const Section& root, const Section& body, const SoilSetup& setup);

/// A factor on yield surfaces, above 0 always, under `key`; absent: 1 for ever.
soil::TimeFactor read_strength_factor(const Section& table, std::string_view key);

/// A table with times and values, or a frequency, under `key`; absent: 1 for ever.
soil::TimeFactor read_time_factor(const Section& table, std::string_view key);

/// The tables [[boundary]]: conditions and where they hold.
void read_soil_boundaries(const Section& root, SoilScene& scene);

}  // namespace talus
