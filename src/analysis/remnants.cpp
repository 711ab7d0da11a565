#include "src/analysis/remnants.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "comm/exact_sum.hpp"
#include "src/analysis/selection.hpp"

namespace talus {

namespace {

Point vector_at(const ParticleSet& particles, const Field<double>& field, std::size_t i) {
    return {particles.data(field, 0)[i], particles.data(field, 1)[i], particles.data(field, 2)[i]};
}

Point eigen_point(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

/// Groups, dealt out among the ranks, or the own particles.
std::vector<BindingUnit> binding_units(const Communicator& comm, const LinkedParticles& linked,
                                       bool particles_bind) {
    std::vector<BindingUnit> units;
    if (particles_bind) {
        const ParticleSet& set = linked.particles;
        for (std::size_t i = 0; i < set.size(); ++i)
            units.push_back({set.data(field::fragment)[i], set.data(field::mass)[i],
                             vector_at(set, field::position, i), vector_at(set, field::velocity, i)});
    } else {
        const auto ranks = static_cast<std::size_t>(comm.size());
        for (auto k = static_cast<std::size_t>(comm.rank()); k < linked.fragments.size(); k += ranks) {
            const Fragment& group = linked.fragments[k];
            units.push_back({group.label, group.mass, group.centre, group.velocity});
        }
    }
    return units;
}

/// The set of each own particle, from that of each unit.
std::vector<std::size_t> sets_of_particles(const Communicator& comm, const LinkedParticles& linked,
                                           const std::vector<BindingUnit>& units, const Binding& binding,
                                           bool particles_bind) {
    if (particles_bind) return binding.set_of;
    struct BoundGroup {
        std::uint64_t label, set;
    };
    std::vector<BoundGroup> bound;
    for (std::size_t u = 0; u < units.size(); ++u)
        if (binding.set_of[u] < binding.sets.size()) bound.push_back({units[u].group, binding.set_of[u]});
    bound = comm.all_gather(std::span<const BoundGroup>(bound));
    const auto earlier = [](const BoundGroup& a, const BoundGroup& b) { return a.label < b.label; };
    std::sort(bound.begin(), bound.end(), earlier);
    std::vector<std::size_t> set_of;
    for (const std::uint64_t label : linked.particles.own(field::fragment)) {
        const auto found = std::lower_bound(bound.begin(), bound.end(), BoundGroup{label, 0}, earlier);
        const bool is_bound = found != bound.end() && found->label == label;
        set_of.push_back(is_bound ? static_cast<std::size_t>(found->set) : binding.sets.size());
    }
    return set_of;
}

/// Integral of mass times the product of each two coordinates from the centre, particles as points; and the
/// moment that the cubes about those points have along each axis.
struct SecondMoments {
    Eigen::Matrix3d of_points;
    double of_cubes;
};

SecondMoments second_moments(const Communicator& comm, const ParticleSet& particles,
                             std::span<const std::uint32_t> chosen, const Point& centre,
                             std::span<const double> spacing) {
    std::vector<ExactSum> sums(7);
    const std::uint8_t* body = particles.data(field::body);
    for (const std::uint32_t i : chosen) {
        const double mass = particles.data(field::mass)[i];
        const Point x = minus(vector_at(particles, field::position, i), centre);
        for (int c = 0; c < 6; ++c) {
            const AxisPair axes = symmetric_axes(c, 3);
            sums[static_cast<std::size_t>(c)].add(mass * x[static_cast<std::size_t>(axes.first)] *
                                                  x[static_cast<std::size_t>(axes.second)]);
        }
        sums[6].add(mass * spacing[body[i]] * spacing[body[i]] / 12);
    }
    ExactSum::all_reduce(comm, sums);
    SecondMoments moments;
    for (int c = 0; c < 6; ++c) {
        const AxisPair axes = symmetric_axes(c, 3);
        moments.of_points(axes.first, axes.second) = moments.of_points(axes.second, axes.first) =
            sums[static_cast<std::size_t>(c)].value();
    }
    moments.of_cubes = sums[6].value();
    return moments;
}

}  // namespace

MatterFigures figures_of(const Communicator& comm, const ParticleSet& particles,
                         std::span<const std::uint32_t> chosen) {
    const double* mass = particles.data(field::mass);
    const bool has_damage = particles.has(field::damage);
    const double* damage = has_damage ? particles.data(field::damage) : nullptr;
    std::vector<ExactSum> sums(9);
    for (const std::uint32_t i : chosen) {
        const Point x = vector_at(particles, field::position, i),
                    v = vector_at(particles, field::velocity, i);
        sums[0].add(mass[i]);
        for (std::size_t a = 0; a < 3; ++a) {
            sums[1 + a].add(mass[i] * x[a]);
            sums[4 + a].add(mass[i] * v[a]);
        }
        if (damage) sums[7].add(mass[i] * damage[i]);
        if (damage && damage[i] >= 1) sums[8].add(mass[i]);
    }
    ExactSum::all_reduce(comm, sums);
    MatterFigures figures;
    figures.particles = comm.all_sum(static_cast<std::uint64_t>(chosen.size()));
    figures.mass = sums[0].value();
    if (!(figures.mass > 0)) return figures;
    for (std::size_t a = 0; a < 3; ++a) {
        figures.centre[a] = sums[1 + a].value() / figures.mass;
        figures.velocity[a] = sums[4 + a].value() / figures.mass;
    }
    if (has_damage) {  // on a rank without particles, too, where there are no values to point at
        figures.mean_damage = sums[7].value() / figures.mass;
        figures.fully_damaged = sums[8].value() / figures.mass;
    }
    std::vector<ExactSum> angular(3);
    for (const std::uint32_t i : chosen) {
        const Point x = minus(vector_at(particles, field::position, i), figures.centre);
        const Point v = minus(vector_at(particles, field::velocity, i), figures.velocity);
        const Point turning = cross(x, v);
        for (std::size_t a = 0; a < 3; ++a) angular[a].add(mass[i] * turning[a]);
    }
    ExactSum::all_reduce(comm, angular);
    for (std::size_t a = 0; a < 3; ++a) figures.angular_momentum[a] = angular[a].value();
    return figures;
}

BodyFigures shape_of(const Communicator& comm, const ParticleSet& particles,
                     std::span<const std::uint32_t> chosen, const MatterFigures& figures,
                     std::span<const double> spacing) {
    const SecondMoments moments = second_moments(comm, particles, chosen, figures.centre, spacing);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments.of_points);  // rising eigenvalues
    BodyFigures shape;
    for (int k = 0; k < 2; ++k) {
        Eigen::Vector3d axis = solver.eigenvectors().col(2 - k);
        Eigen::Index largest;
        axis.cwiseAbs().maxCoeff(&largest);
        if (axis[largest] < 0) axis = -axis;
        shape.axes[static_cast<std::size_t>(k)] = eigen_point(axis);
    }
    shape.axes[2] = cross(shape.axes[0], shape.axes[1]);

    const double trace = moments.of_points.trace();
    double volume = 4 * std::numbers::pi / 3;
    for (std::size_t k = 0; k < 3; ++k) {
        const double points = std::max(solver.eigenvalues()[2 - static_cast<int>(k)], 0.0);
        shape.semi_axes[k] = std::sqrt(5 * (points + moments.of_cubes) / figures.mass);
        volume *= shape.semi_axes[k];
        // Particles carry no spin of their own: points alone make the inertia that the momentum belongs to.
        const double inertia = trace - points;
        if (inertia > 1e-12 * trace)
            shape.spin = plus(shape.spin,
                              times(dot(figures.angular_momentum, shape.axes[k]) / inertia, shape.axes[k]));
    }
    shape.density = figures.mass / volume;

    std::array<double, 6> ends;
    ends.fill(-std::numeric_limits<double>::infinity());
    const std::uint8_t* body = particles.data(field::body);
    for (const std::uint32_t i : chosen) {
        const Point x = minus(vector_at(particles, field::position, i), figures.centre);
        for (std::size_t k = 0; k < 3; ++k) {
            const double along = dot(x, shape.axes[k]), half = 0.5 * spacing[body[i]];
            ends[2 * k] = std::max(ends[2 * k], along + half);
            ends[2 * k + 1] = std::max(ends[2 * k + 1], half - along);
        }
    }
    comm.all_max(std::span<double>(ends));
    for (std::size_t k = 0; k < 3; ++k) shape.extents[k] = ends[2 * k] + ends[2 * k + 1];
    return shape;
}

Remnants find_remnants(const Communicator& comm, const LinkedParticles& linked, const RemnantRules& rules) {
    const ParticleSet& particles = linked.particles;
    const std::vector<BindingUnit> units = binding_units(comm, linked, rules.particles_bind);
    const Binding binding = find_bound(comm, units, linked.fragments, rules.binding);
    const std::vector<std::size_t> set_of =
        sets_of_particles(comm, linked, units, binding, rules.particles_bind);

    const FieldInfo* const fields[] = {
        &field::velocity,         &field::mass,    &field::body, &field::damage,
        &field::smoothing_length, &field::fragment};
    std::vector<std::uint32_t> bound;
    for (std::uint32_t i = 0; i < particles.size(); ++i)
        if (set_of[i] < binding.sets.size()) bound.push_back(i);
    Remnants remnants{0, {}, selected("remnants", particles, bound, fields)};
    remnants.bound.add(field::remnant);
    for (std::size_t k = 0; k < bound.size(); ++k)
        remnants.bound.data(field::remnant)[k] = static_cast<std::uint8_t>(set_of[bound[k]] + 1);

    std::vector<ExactSum> mass(1);
    mass[0].add(particles.own(field::mass));
    ExactSum::all_reduce(comm, mass);
    remnants.mass = mass[0].value();
    const std::uint64_t* label = particles.data(field::fragment);
    for (std::size_t k = 0; k < binding.sets.size(); ++k) {
        Remnant remnant{binding.sets[k], {}, {}, {}};
        std::vector<std::uint32_t> all, body;
        for (const std::uint32_t i : bound) {
            if (set_of[i] != k) continue;
            all.push_back(i);
            if (label[i] == remnant.set.seed) body.push_back(i);
        }
        remnant.bound = figures_of(comm, particles, all);
        remnant.body = figures_of(comm, particles, body);
        if (remnant.body.particles > 0)
            remnant.shape = shape_of(comm, particles, body, remnant.body, rules.spacing);
        remnants.list.push_back(remnant);
    }
    return remnants;
}

}  // namespace talus
