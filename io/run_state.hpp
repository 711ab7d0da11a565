#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace talus {

/// The state of a run besides its particles. `numbers` holds what else a run needs to go on with the same
/// bits (sums so far, counters of random streams as doubles); nothing that differs between equal states,
/// such as wall time, belongs there, since it is hashed.
struct RunState {
    double time = 0;             ///< [s]
    double time_step = 0;        ///< [s]
    std::uint64_t step = 0;      ///< steps done
    std::string scene_text;      ///< the scene file, verbatim
    std::string resolved_scene;  ///< Scene::resolved()
    std::string version;         ///< of the program; for information only
    /// Names of the bodies' materials, in order of bodies; empty: not known.
    std::vector<std::string> materials;
    std::vector<std::string> walls;  ///< names and kinds of walls or boundaries, in order
    std::map<std::string, double> numbers;
};

}  // namespace talus
