#pragma once
#include <optional>
#include <string>
#include <vector>

#include "comm/communicator.hpp"
#include "io/scene.hpp"
#include "src/setup/scene_setup.hpp"
#include "src/setup/shapes.hpp"
#include "src/setup/soil_lattice.hpp"
#include "src/soil_simulation.hpp"

namespace talus {

/// A region of soil of one material.
struct SoilBody {
    std::string name;
    BodyShape shape;
    Point velocity{};  ///< at the start [m/s]
};

/// Effective stress at the start: a pressure, and the weight of what is above with a ratio of horizontal to
/// vertical stress.
struct InitialStress {
    double pressure = 0;            ///< compression positive [Pa]
    std::optional<double> surface;  ///< height of the surface along gravity's axis [m]; none: no weight
    double lateral_ratio = 1;       ///< K0 [1]
};

/// A scene of soil, read and checked.
struct SoilScene {
    std::string title;
    SoilSetup simulation;
    std::vector<SoilBody> bodies;
    SoilLattice lattice;
    double smoothing = 0;  ///< smoothing length over the spacing [1]
    double jitter = 0;     ///< random displacement of inner nodes along each axis, at most, in spacings [1]
    InitialStress initial_stress;
    OutputPlan output;
    std::uint64_t seed = 0;
};

/// Whether the scene is one of soil: it has a table [soil].
bool is_soil_scene(const Scene& scene);

/// Reads everything such a scene says. Throws SceneError (on every rank) with all faults at once. Collective.
SoilScene read_soil_scene(const Communicator& comm, const Scene& scene);

/// An empty set with the fields that the scene's models need.
ParticleSet empty_soil(const SoilSetup& setup);

/// The scene's nodes and elements at time 0, on any ranks; nodes have the lower ids.
ParticleSet make_soil(const Communicator& comm, const SoilScene& scene);

}  // namespace talus
