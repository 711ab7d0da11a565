#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "comm/communicator.hpp"
#include "src/setup/depth_scene.hpp"

namespace talus::test {

/// All columns of a depth-integrated flow in order of id, on every rank.
struct DepthResult {
    double time;                        ///< [s]
    std::uint64_t steps;                ///< taken
    std::vector<double> x, y;           ///< place in plan [m]; y is 0 in 1D
    std::vector<double> u, v;           ///< velocity in plan [m/s]
    std::vector<double> depth, volume;  ///< [m], [m3]
    DepthTotals first, last;            ///< at the start and at the end
    double greatest_speed;              ///< met at the end of any step [m/s]

    /// sum |error(k)| V_k / sum V_k over the particles with low < x < high.
    double mean_error(const std::function<double(std::size_t)>& error, double low, double high) const;
};

/// The scene of a file, with overrides. Collective.
DepthScene depth_scene(const Communicator& comm, const std::filesystem::path& scene,
                       const std::vector<std::string>& overrides);

/// Runs a scene to its end as the program does, without writing files. Collective.
DepthResult run_depth(const Communicator& comm, const DepthScene& scene);

}  // namespace talus::test
