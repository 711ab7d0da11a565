#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "domain/particles.hpp"
#include "physics/soil/constitutive.hpp"
#include "physics/soil/stencils.hpp"
#include "physics/soil/taylor_galerkin.hpp"
#include "physics/soil/time_factor.hpp"

namespace talus::soil {

/// Face of a body: 2 axis for the lower end of an axis, 2 axis + 1 for the upper one.
using Face = int;
constexpr int axis_of(Face face) { return face / 2; }
constexpr double outward(Face face) { return face % 2 == 0 ? -1 : 1; }

/// What holds on some nodes. Where nothing is said, faces are free of stress.
struct BoundaryCondition {
    enum class Kind : unsigned char { free_slip, velocity, traction, pore_pressure };
    std::string name;
    Kind kind = Kind::traction;
    Face face = -1;                 ///< -1: no face, all nodes of a region (of velocities only)
    std::array<bool, 3> held{};     ///< components of the velocity that are imposed
    std::array<double, 3> value{};  ///< velocity [m/s], traction on the face or pore pressure [Pa]
    TimeFactor factor;
    std::array<double, 3> lower{}, upper{};  ///< where it holds [m]
};

/// How far beyond the edge of its region a condition holds, in spacings.
constexpr double reach_beyond(BoundaryCondition::Kind kind) {
    return 1e-3 + (kind == BoundaryCondition::Kind::traction ? 1 : 0);
}

/// A node on a face or with conditions.
struct BoundaryNode {
    std::uint32_t index;
    std::uint32_t face_row;    ///< of Stencils::to_faces, if `faces` is not 0
    std::uint8_t faces;        ///< as soil_field::faces
    std::uint32_t conditions;  ///< as soil_field::conditions
    /// Of the load of each condition: it is spread over a spacing to both sides of its edges, for no stress
    /// of elements can balance what changes from node to node.
    std::vector<double> shares;
};

/// Of a rank's own nodes, by where they were at the start.
std::vector<BoundaryNode> list_boundary_nodes(const ParticleSet& particles, const Stencils& stencils,
                                              std::span<const BoundaryCondition> conditions, double spacing);

/// How nodes on faces may move, and whether that changes the water's volume.
struct FreeAxes {
    /// Of each row of Stencils::to_faces, bit a: the divergence there depends on the velocity along axis a,
    /// and that is not imposed.
    std::vector<std::uint8_t> of_row;
    bool any_tight = false;  ///< some have no imposed pore pressure
};
FreeAxes list_free_axes(std::span<const BoundaryNode> nodes, std::span<const BoundaryCondition> conditions,
                        const Stencils& stencils, int dimension, double spacing);

/// Imposes velocities at `time` on nodes.
void impose_velocities(ParticleSet& particles, std::span<const BoundaryNode> nodes,
                       std::span<const BoundaryCondition> conditions, double time);

/// What tractions of soil and water together at `time`, 0 where nothing else is said, add to the divergence
/// of the stress at nodes on faces: D values for each row of Stencils::to_faces. Of the velocity and the
/// traction along one axis only one can be imposed on a face: the velocity goes first.
void gather_tractions(std::span<const BoundaryNode> nodes, std::span<const BoundaryCondition> conditions,
                      double time, const Stencils& stencils, int dimension, std::vector<double>& divergence);

/// Adds to the velocity of nodes what tractions at `time` do in a time step, on the faces as they were at the
/// start.
void apply_loads(ParticleSet& particles, std::span<const BoundaryNode> nodes,
                 std::span<const BoundaryCondition> conditions, double time, const StepSettings& settings);

/// In 1D: makes the stress at loaded ends at `time` that of the load, less that of the water.
void impose_end_stress(ParticleSet& particles, std::span<const BoundaryNode> nodes,
                       std::span<const BoundaryCondition> conditions, double time);

/// Imposes pore pressures at `time`; returns the nodes where they are.
std::vector<std::uint32_t> impose_pore_pressures(ParticleSet& particles, std::span<const BoundaryNode> nodes,
                                                 std::span<const BoundaryCondition> conditions, double time);

/// Tributary area of a node on one face of it, from its mass [m^(D-1)].
inline double face_area(double mass, double density, double spacing) {
    return 2 * mass / (density * spacing);
}

}  // namespace talus::soil
