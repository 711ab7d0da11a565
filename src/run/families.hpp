#pragma once
#include <memory>
#include <optional>

#include "comm/communicator.hpp"
#include "io/scene.hpp"
#include "src/run/evolution.hpp"

namespace talus {

/// A family of models that scenes choose by the tables they have, and how such a scene is run and checked.
struct Family {
    bool (*describes)(const Scene&);  ///< whether the scene is of this family
    std::unique_ptr<Evolution> (*read)(const Communicator&, const Scene&, std::optional<double> until);
    int (*check)(const Communicator&, const Scene&);  ///< `talus check`: returns the exit code; collective
};

/// `talus check` of bodies of SPH. Collective.
int check_sph_scene(const Communicator& comm, const Scene& scene);

/// The same of grains. Collective.
int check_grain_scene(const Communicator& comm, const Scene& scene);

/// The same of water with grains in it. Collective.
int check_coupled_scene(const Communicator& comm, const Scene& scene);

/// The same of depth-integrated flows. Collective.
int check_depth_scene(const Communicator& comm, const Scene& scene);

/// The same of soil. Collective.
int check_soil_scene(const Communicator& comm, const Scene& scene);

/// The same of water. Collective.
int check_water_scene(const Communicator& comm, const Scene& scene);

}  // namespace talus
