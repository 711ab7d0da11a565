#include "physics/soil/boundary_conditions.hpp"

#include <cmath>
#include <utility>

#include "domain/soil_fields.hpp"
#include "physics/soil/node_density.hpp"
#include "physics/soil/state_columns.hpp"

namespace talus::soil {

namespace {

/// Of a load that ends at a distance, in spacings, positive within: a step smoothed by the mean over a
/// spacing and by (1/4, 1/2, 1/4).
double share_within(double distance) {
    if (distance >= 2) return 1;
    if (distance <= -2) return 0;
    const double beyond = std::abs(distance);
    const double missing = beyond < 1 ? 0.5 - 0.375 * beyond : 0.125 * (2 - beyond);
    return distance > 0 ? 1 - missing : missing;
}

double share_of_face(const BoundaryCondition& condition, const std::array<double, 3>& at, int dimension,
                     std::uint8_t faces, double spacing) {
    double share = 1;
    for (int axis = 0; axis < dimension; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        // Where the body ends too, all of the face is loaded.
        if (!(faces >> (2 * axis) & 1)) share *= share_within((at[a] - condition.lower[a]) / spacing);
        if (!(faces >> (2 * axis + 1) & 1)) share *= share_within((condition.upper[a] - at[a]) / spacing);
    }
    return share;
}

}  // namespace

std::vector<BoundaryNode> list_boundary_nodes(const ParticleSet& particles, const Stencils& stencils,
                                              std::span<const BoundaryCondition> conditions, double spacing) {
    const std::uint8_t* faces = particles.data(soil_field::faces);
    const std::uint32_t* held = particles.data(soil_field::conditions);
    const bool moves = particles.has(soil_field::surface);
    std::vector<BoundaryNode> listed;
    std::uint32_t face_row = 0;
    stencils.for_each_node([&](std::uint32_t i) {
        if (faces[i] == 0 && held[i] == 0) return;
        std::array<double, 3> at{};
        for (int a = 0; a < particles.dimension(); ++a)
            at[static_cast<std::size_t>(a)] = particles.data(field::position, a)[i] -
                                              (moves ? particles.data(soil_field::displacement, a)[i] : 0);
        BoundaryNode node{i, face_row, faces[i], held[i], {}};
        face_row += faces[i] != 0;
        for (const BoundaryCondition& condition : conditions)
            node.shares.push_back(share_of_face(condition, at, particles.dimension(), faces[i], spacing));
        listed.push_back(std::move(node));
    });
    return listed;
}

namespace {

using Kind = BoundaryCondition::Kind;

/// Calls visit(condition, its factor, its share) for the conditions of a node, in their order.
template <class Visit>
void for_each_condition(const BoundaryNode& node, std::span<const BoundaryCondition> conditions,
                        std::span<const double> factors, Visit&& visit) {
    for (std::size_t c = 0; c < conditions.size(); ++c)
        if (node.conditions >> c & 1) visit(conditions[c], factors[c], node.shares[c]);
}

std::vector<double> factors_at(std::span<const BoundaryCondition> conditions, double time) {
    std::vector<double> factors;
    factors.reserve(conditions.size());
    for (const BoundaryCondition& condition : conditions) factors.push_back(condition.factor(time));
    return factors;
}

/// What is imposed on one face of a node.
struct OnFace {
    std::array<bool, 3> held{};  ///< velocities
    std::array<double, 3> traction{};
};

OnFace on_face(const BoundaryNode& node, Face face, std::span<const BoundaryCondition> conditions,
               std::span<const double> factors) {
    OnFace found;
    for_each_condition(
        node, conditions, factors, [&](const BoundaryCondition& condition, double factor, double share) {
            if (condition.face >= 0 && condition.face != face) return;
            for (std::size_t a = 0; a < 3 && condition.kind != Kind::pore_pressure; ++a)
                if (condition.kind == Kind::traction)
                    found.traction[a] += share * (condition.value[a] * factor - found.traction[a]);
                else
                    found.held[a] = found.held[a] || condition.held[a];
        });
    return found;
}

}  // namespace

FreeAxes list_free_axes(std::span<const BoundaryNode> nodes, std::span<const BoundaryCondition> conditions,
                        const Stencils& stencils, int dimension, double spacing) {
    constexpr double rounding = 1e-6;
    const auto axes = static_cast<std::size_t>(dimension);
    FreeAxes found{std::vector<std::uint8_t>(stencils.to_faces.targets.size(), 0)};
    for (const BoundaryNode& node : nodes) {
        if (node.faces == 0) continue;
        unsigned free = 0;
        bool drained = false;
        for (std::size_t a = 0; a < axes; ++a)
            if (std::abs(stencils.own_weights[node.face_row * axes + a]) * spacing > rounding)
                free |= 1u << a;
        for (std::size_t c = 0; c < conditions.size(); ++c) {
            if (!(node.conditions >> c & 1)) continue;
            drained = drained || conditions[c].kind == Kind::pore_pressure;
            for (std::size_t a = 0; a < axes; ++a)
                if (conditions[c].held[a]) free &= ~(1u << a);
        }
        found.of_row[node.face_row] = static_cast<std::uint8_t>(free);
        found.any_tight = found.any_tight || (free != 0 && !drained);
    }
    return found;
}

void impose_velocities(ParticleSet& particles, std::span<const BoundaryNode> nodes,
                       std::span<const BoundaryCondition> conditions, double time) {
    const std::vector<double> factors = factors_at(conditions, time);
    for (int axis = 0; axis < particles.dimension(); ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        double* velocity = particles.data(soil_field::velocity, axis);
        for (const BoundaryNode& node : nodes)
            for_each_condition(node, conditions, factors,
                               [&](const BoundaryCondition& condition, double factor, double) {
                                   if (condition.held[a]) velocity[node.index] = condition.value[a] * factor;
                               });
    }
}

std::vector<std::uint32_t> impose_pore_pressures(ParticleSet& particles, std::span<const BoundaryNode> nodes,
                                                 std::span<const BoundaryCondition> conditions, double time) {
    const std::vector<double> factors = factors_at(conditions, time);
    std::vector<std::uint32_t> imposed;
    for (const BoundaryNode& node : nodes)
        for_each_condition(
            node, conditions, factors, [&](const BoundaryCondition& condition, double factor, double) {
                if (condition.kind != Kind::pore_pressure) return;
                particles.data(soil_field::pore_pressure)[node.index] = condition.value[0] * factor;
                if (imposed.empty() || imposed.back() != node.index) imposed.push_back(node.index);
            });
    return imposed;
}

void impose_end_stress(ParticleSet& particles, std::span<const BoundaryNode> nodes,
                       std::span<const BoundaryCondition> conditions, double time) {
    const std::vector<double> factors = factors_at(conditions, time);
    double* stress = particles.data(soil_field::stress);
    const double* water =
        particles.has(soil_field::pore_pressure) ? particles.data(soil_field::pore_pressure) : nullptr;
    for (const BoundaryNode& node : nodes)
        for (Face face = 0; face < 2; ++face) {
            if (!(node.faces >> face & 1)) continue;
            const OnFace imposed = on_face(node, face, conditions, factors);
            if (!imposed.held[0])
                stress[node.index] = outward(face) * imposed.traction[0] + (water ? water[node.index] : 0);
        }
}

void gather_tractions(std::span<const BoundaryNode> nodes, std::span<const BoundaryCondition> conditions,
                      double time, const Stencils& stencils, int dimension, std::vector<double>& divergence) {
    const std::vector<double> factors = factors_at(conditions, time);
    const auto axes = static_cast<std::size_t>(dimension);
    divergence.assign(stencils.to_faces.targets.size() * axes, 0);
    for (const BoundaryNode& node : nodes)
        for (Face face = 0; face < 2 * dimension; ++face) {
            if (!(node.faces >> face & 1)) continue;
            const OnFace imposed = on_face(node, face, conditions, factors);
            const std::size_t row = node.face_row * axes;
            const double weight =
                outward(face) * stencils.own_weights[row + static_cast<std::size_t>(axis_of(face))];
            for (std::size_t b = 0; b < axes; ++b)
                if (!imposed.held[b]) divergence[row + b] += weight * imposed.traction[b];
        }
}

void apply_loads(ParticleSet& particles, std::span<const BoundaryNode> nodes,
                 std::span<const BoundaryCondition> conditions, double time, const StepSettings& settings) {
    const std::vector<double> factors = factors_at(conditions, time);
    const NodeDensity density(particles, settings.materials);
    for (const BoundaryNode& node : nodes)
        for (Face face = 0; face < 2 * particles.dimension(); ++face) {
            if (!(node.faces >> face & 1) || node.conditions == 0) continue;
            const OnFace imposed = on_face(node, face, conditions, factors);
            const double mass = particles.data(field::mass)[node.index];
            const double area = face_area(mass, density[node.index], settings.spacing);
            for (int a = 0; a < particles.dimension(); ++a)
                if (!imposed.held[static_cast<std::size_t>(a)])
                    particles.data(soil_field::velocity, a)[node.index] +=
                        settings.time_step * area / mass * imposed.traction[static_cast<std::size_t>(a)];
        }
}

}  // namespace talus::soil
