#pragma once
#include <optional>
#include <string>
#include <vector>

#include "comm/communicator.hpp"
#include "io/scene.hpp"
#include "src/setup/bodies.hpp"
#include "src/setup/buffer_reader.hpp"
#include "src/setup/scene_setup.hpp"
#include "src/water/gauges.hpp"
#include "src/water_simulation.hpp"

namespace talus {

/// A scene of water, read and checked.
struct WaterScene {
    std::string title;
    WaterSetup simulation;
    std::vector<Body> bodies;                    ///< water and walls
    std::vector<BodyCensus> census;              ///< one a body
    std::vector<std::optional<double>> surface;  ///< of a body at rest under it: height against gravity [m]
    double spacing = 0;                          ///< of the water [m]
    double greatest_speed = 0;                   ///< that the scene expects [m/s]; 0: not said
    std::vector<InflowProfile> profiles{};       ///< one a body; of those that are inflows
    std::vector<WaterGauge> gauges{};
    std::vector<std::string> warnings;  ///< what a user should know
    OutputPlan output;
    std::uint64_t seed = 0;

    std::vector<std::string> body_names() const;
    /// Of a body, where it is thinnest.
    double particles_across(std::size_t body) const;
};

/// Whether a scene describes water.
bool is_water_scene(const Scene& scene);

/// Reads everything a scene says. Throws SceneError (on every rank) with all faults at once. Collective.
WaterScene read_water_scene(const Communicator& comm, const Scene& scene);
/// The same for a scene that says more than that: faults are only recorded in it.
WaterScene read_water(const Communicator& comm, const Scene& scene);

/// An empty set with the fields the scene's models need.
ParticleSet empty_water(const WaterSetup& setup);

/// The scene's particles at time 0, each rank its share. Collective.
ParticleSet make_water(const Communicator& comm, const WaterScene& scene);

}  // namespace talus
