#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "domain/particles.hpp"
#include "physics/soil/constitutive.hpp"
#include "physics/soil/stencils.hpp"
#include "physics/soil/time_factor.hpp"

namespace talus::soil {

/// Face of a body: 2 axis for the lower end of an axis, 2 axis + 1 for the upper one.
using Face = int;
constexpr int axis_of(Face face) { return face / 2; }
constexpr double outward(Face face) { return face % 2 == 0 ? -1 : 1; }

/// What holds on some nodes. Where nothing is said, faces are free of stress.
struct BoundaryCondition {
    enum class Kind : unsigned char { free_slip, velocity, traction };
    std::string name;
    Kind kind = Kind::traction;
    Face face = -1;                 ///< -1: no face, all nodes of a region (of velocities only)
    std::array<bool, 3> held{};     ///< components of the velocity that are imposed
    std::array<double, 3> value{};  ///< velocity [m/s] or traction on the face [Pa]
    TimeFactor factor;
};

/// A node on a face or with conditions.
struct BoundaryNode {
    std::uint32_t index;
    std::uint8_t faces;        ///< as soil_field::faces
    std::uint32_t conditions;  ///< as soil_field::conditions
};

/// Of a rank's own nodes.
std::vector<BoundaryNode> list_boundary_nodes(const ParticleSet& particles, const Stencils& stencils);

/// Imposes velocities at `time` on nodes.
void impose_velocities(ParticleSet& particles, std::span<const BoundaryNode> nodes,
                       std::span<const BoundaryCondition> conditions, double time);

/// Imposes tractions at `time` on the faces that nodes lie on, 0 where nothing else is said. Of the velocity
/// and the traction along one axis only one can be imposed on a face: the velocity goes first.
void impose_tractions(ParticleSet& particles, std::span<const BoundaryNode> nodes,
                      std::span<const BoundaryCondition> conditions, double time);

/// The same where stresses have relaxed at a fixed strain: the soil stretches across the faces until the
/// tractions hold there, which changes the other normal stresses too.
void yield_to_tractions(ParticleSet& particles, std::span<const BoundaryNode> nodes,
                        std::span<const BoundaryCondition> conditions, double time,
                        std::span<const Material> materials);

/// Tributary area of a node on one face of it, from its mass [m^(D-1)].
inline double face_area(double mass, double density, double spacing) {
    return 2 * mass / (density * spacing);
}

}  // namespace talus::soil
