#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "comm/communicator.hpp"
#include "domain/box.hpp"
#include "io/scene.hpp"
#include "src/setup/bodies.hpp"

namespace talus {

/// What a body's table is read with.
struct BodyContext {
    const Communicator& comm;
    const Scene& scene;
    int dimension;
    BoxShape domain;                     ///< what shape = "domain" fills: the whole box
    std::array<Boundary, 3> boundaries;  ///< of the box
    const Body* first_body;  ///< of the scene, whose resolution others follow; null for the first itself
    bool in_impact;          ///< place and velocity come from [impact]
    double gravitational_constant;  ///< of [gravity] [m3 kg-1 s-2]; 0: there is none
    std::uint64_t seed;
};

/// A vector with as many components as the scene has dimensions.
Point read_point(const Section& table, std::string_view key, std::string_view unit, int dimension,
                 std::optional<std::vector<double>> default_value = {});
/// The same, zero if it is not given.
Point origin_default(const Section& table, std::string_view key, std::string_view unit, int dimension);

/// Path of a file that a scene names: from the scene's folder, else from the folder of the environment
/// variable TALUS_DATA. Collective.
std::string find_file(const Communicator& comm, const Scene& scene, const std::string& name);

/// The region that a body's table names. `density`: what a mass is made of [kg/m3]. Faults are recorded in
/// the scene. Collective.
BodyShape read_shape(const Section& table, double density, const BodyContext& context);

}  // namespace talus
