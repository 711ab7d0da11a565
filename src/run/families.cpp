#include "src/run/families.hpp"

#include <algorithm>
#include <array>

#include "src/run/commands.hpp"
#include "src/run/coupled_evolution.hpp"
#include "src/run/depth_evolution.hpp"
#include "src/run/grain_evolution.hpp"
#include "src/run/soil_evolution.hpp"
#include "src/run/sph_evolution.hpp"
#include "src/run/water_evolution.hpp"

namespace talus {

namespace {

template <class Model>
std::unique_ptr<Evolution> read(const Communicator& comm, const Scene& scene, std::optional<double> until) {
    return std::make_unique<Model>(comm, scene, until);
}

bool any_scene(const Scene&) { return true; }

/// In the order in which they are asked; the last describes every scene.
constexpr std::array all_families = {
    Family{is_depth_scene, read<DepthEvolution>, check_depth_scene},
    Family{is_coupled_scene, read<CoupledEvolution>, check_coupled_scene},
    Family{is_grain_scene, read<GrainEvolution>, check_grain_scene},
    Family{is_soil_scene, read<SoilEvolution>, check_soil_scene},
    Family{is_water_scene, read<WaterEvolution>, check_water_scene},
    Family{any_scene, read<SphEvolution>, check_sph_scene},
};

const Family& family_of(const Scene& scene) {
    return *std::find_if(all_families.begin(), all_families.end(),
                         [&](const Family& family) { return family.describes(scene); });
}

}  // namespace

std::unique_ptr<Evolution> read_evolution(const Communicator& comm, const Scene& scene,
                                          std::optional<double> until) {
    return family_of(scene).read(comm, scene, until);
}

int check_scene(const Communicator& comm, const RunOptions& options) {
    const Scene scene = load_scene(comm, options);
    return family_of(scene).check(comm, scene);
}

}  // namespace talus
