#include "physics/soil/boundary_conditions.hpp"

#include "domain/soil_fields.hpp"
#include "physics/soil/state_columns.hpp"

namespace talus::soil {

std::vector<BoundaryNode> list_boundary_nodes(const ParticleSet& particles, const Stencils& stencils) {
    const std::uint8_t* faces = particles.data(soil_field::faces);
    const std::uint32_t* conditions = particles.data(soil_field::conditions);
    std::vector<BoundaryNode> listed;
    stencils.for_each_node([&](std::uint32_t i) {
        if (faces[i] != 0 || conditions[i] != 0) listed.push_back({i, faces[i], conditions[i]});
    });
    return listed;
}

namespace {

using Kind = BoundaryCondition::Kind;

/// Calls visit(condition, its factor) for the conditions of a node, in their order.
template <class Visit>
void for_each_condition(const BoundaryNode& node, std::span<const BoundaryCondition> conditions,
                        std::span<const double> factors, Visit&& visit) {
    for (std::size_t c = 0; c < conditions.size(); ++c)
        if (node.conditions >> c & 1) visit(conditions[c], factors[c]);
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
    for_each_condition(node, conditions, factors, [&](const BoundaryCondition& condition, double factor) {
        if (condition.face >= 0 && condition.face != face) return;
        for (std::size_t a = 0; a < 3; ++a)
            if (condition.kind == Kind::traction)
                found.traction[a] = condition.value[a] * factor;
            else
                found.held[a] = found.held[a] || condition.held[a];
    });
    return found;
}

template <int D>
void impose_tractions_in(ParticleSet& particles, std::span<const BoundaryNode> nodes,
                         std::span<const BoundaryCondition> conditions, std::span<const double> factors) {
    const auto stress = sph::components_to_write<sph::symmetric_count<D>>(particles, soil_field::stress);
    for (const BoundaryNode& node : nodes)
        for (Face face = 0; face < 2 * D; ++face) {
            if (!(node.faces >> face & 1)) continue;
            const OnFace imposed = on_face(node, face, conditions, factors);
            for (int b = 0; b < D; ++b)
                if (!imposed.held[static_cast<std::size_t>(b)])
                    stress[static_cast<std::size_t>(sph::symmetric_index<D>(axis_of(face), b))][node.index] =
                        outward(face) * imposed.traction[static_cast<std::size_t>(b)];
        }
}

/// Changes of normal stresses that were imposed change the others as the strain along these stays the same.
template <int D>
class NormalStresses {
  public:
    explicit NormalStresses(ParticleSet& particles) : columns_(particles) {}

    void remember(std::size_t i) {
        for (std::size_t a = 0; a < D; ++a) before_[a] = columns_.stress[a][i];
    }
    void follow(std::size_t i, double poisson_ratio) const {
        double sum = 0;
        int changed = 0;
        std::array<bool, 3> imposed{};
        for (std::size_t a = 0; a < D; ++a) {
            const double change = columns_.stress[a][i] - before_[a];
            imposed[a] = change != 0;
            changed += imposed[a];
            sum += change;
        }
        if (changed == 0 || changed == 3) return;
        const double follows = (changed == 1 ? poisson_ratio / (1 - poisson_ratio) : poisson_ratio) * sum;
        for (std::size_t a = 0; a < D; ++a)
            if (!imposed[a]) columns_.stress[a][i] += follows;
        if (D < 3) columns_.lateral[i] += follows;
    }

  private:
    StateColumns<D> columns_;
    std::array<double, D> before_{};
};

template <int D>
void yield_to_tractions_in(ParticleSet& particles, std::span<const BoundaryNode> nodes,
                           std::span<const BoundaryCondition> conditions, std::span<const double> factors,
                           std::span<const Material> materials) {
    NormalStresses<D> normal(particles);
    const std::uint8_t* body = particles.data(field::body);
    for (const BoundaryNode& node : nodes) {
        const Elasticity& elasticity = materials[body[node.index]].elasticity;
        normal.remember(node.index);
        impose_tractions_in<D>(particles, std::span(&node, 1), conditions, factors);
        if (!elasticity.uniaxial_stress) normal.follow(node.index, elasticity.poisson_ratio);
    }
}

}  // namespace

void impose_velocities(ParticleSet& particles, std::span<const BoundaryNode> nodes,
                       std::span<const BoundaryCondition> conditions, double time) {
    const std::vector<double> factors = factors_at(conditions, time);
    for (int axis = 0; axis < particles.dimension(); ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        double* velocity = particles.data(soil_field::velocity, axis);
        for (const BoundaryNode& node : nodes)
            for_each_condition(node, conditions, factors,
                               [&](const BoundaryCondition& condition, double factor) {
                                   if (condition.held[a]) velocity[node.index] = condition.value[a] * factor;
                               });
    }
}

void impose_tractions(ParticleSet& particles, std::span<const BoundaryNode> nodes,
                      std::span<const BoundaryCondition> conditions, double time) {
    const std::vector<double> factors = factors_at(conditions, time);
    sph::with_dimension(particles, [&](auto dimension) {
        impose_tractions_in<dimension()>(particles, nodes, conditions, factors);
    });
}

void yield_to_tractions(ParticleSet& particles, std::span<const BoundaryNode> nodes,
                        std::span<const BoundaryCondition> conditions, double time,
                        std::span<const Material> materials) {
    const std::vector<double> factors = factors_at(conditions, time);
    sph::with_dimension(particles, [&](auto dimension) {
        yield_to_tractions_in<dimension()>(particles, nodes, conditions, factors, materials);
    });
}

}  // namespace talus::soil
