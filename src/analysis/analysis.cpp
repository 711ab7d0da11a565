#include "src/analysis/analysis.hpp"

#include "comm/exact_sum.hpp"

namespace talus {

namespace {

double outward_speed(const Antipode& antipode, const ParticleSet& particles, std::size_t i) {
    double speed = 0;
    for (int a = 0; a < particles.dimension(); ++a) {
        const auto axis = static_cast<std::size_t>(a);
        speed +=
            (particles.data(field::velocity, a)[i] - antipode.first_velocity[axis]) * antipode.outward[axis];
    }
    return speed;
}

bool is_near(const Antipode& antipode, const ParticleSet& particles, std::size_t i) {
    double distance2 = 0;
    for (int a = 0; a < particles.dimension(); ++a) {
        const double d = particles.data(field::position, a)[i] - antipode.point[static_cast<std::size_t>(a)];
        distance2 += d * d;
    }
    return distance2 < antipode.radius * antipode.radius;
}

/// What is added up over the particles themselves, fragments or not.
void add_up(const Communicator& comm, const AnalysisPlan& plan, const ParticleSet& particles,
            Breakup& breakup) {
    enum Sum { all, broken, antipode_mass, antipode_momentum, momentum, sum_count = momentum + 3 };
    std::vector<ExactSum> sums(sum_count);
    const std::uint8_t* body = particles.data(field::body);
    const double* mass = particles.data(field::mass);
    const double* damage = particles.has(field::damage) ? particles.data(field::damage) : nullptr;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        if (!(plan.rules.linking_length[body[i]] > 0)) continue;
        sums[all].add(mass[i]);
        for (int a = 0; a < particles.dimension(); ++a)
            sums[momentum + static_cast<std::size_t>(a)].add(mass[i] * particles.data(field::velocity, a)[i]);
        if (damage && damage[i] >= 1) sums[broken].add(mass[i]);
        if (plan.antipode && body[i] == plan.antipode->body && is_near(*plan.antipode, particles, i)) {
            sums[antipode_mass].add(mass[i]);
            sums[antipode_momentum].add(mass[i] * outward_speed(*plan.antipode, particles, i));
        }
    }
    ExactSum::all_reduce(comm, sums);
    breakup.mass = sums[all].value();
    for (std::size_t a = 0; a < 3; ++a) breakup.velocity[a] = sums[momentum + a].value() / breakup.mass;
    breakup.fully_damaged = sums[broken].value() / breakup.mass;
    breakup.antipode_mass = sums[antipode_mass].value();
    if (breakup.antipode_mass > 0)
        breakup.antipode_speed = sums[antipode_momentum].value() / breakup.antipode_mass;
}

}  // namespace

Breakup analyse(const Communicator& comm, const AnalysisPlan& plan, const Box& box,
                const ParticleSet& particles) {
    Breakup breakup;
    if (plan.fragments) add_up(comm, plan, particles, breakup);
    const bool same_groups = plan.fragments && plan.remnants && plan.rules == plan.remnants->groups;
    if (plan.fragments && !same_groups) breakup.fragments = find_fragments(comm, box, particles, plan.rules);
    if (plan.remnants) {
        const LinkedParticles linked = link_particles(comm, box, particles, plan.remnants->groups);
        breakup.remnants = find_remnants(comm, linked, *plan.remnants);
        if (same_groups) breakup.fragments = linked.fragments;
    }
    for (const Fragment& fragment : breakup.fragments) breakup.in_fragments += fragment.mass / breakup.mass;
    return breakup;
}

}  // namespace talus
