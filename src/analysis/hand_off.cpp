#include "src/analysis/hand_off.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "comm/exact_sum.hpp"

namespace talus {

namespace {

Point vector_at(const ParticleSet& particles, const Field<double>& field, std::size_t i) {
    return {particles.data(field, 0)[i], particles.data(field, 1)[i], particles.data(field, 2)[i]};
}

Point rounded(std::span<const ExactSum> sums) { return {sums[0].value(), sums[1].value(), sums[2].value()}; }

/// What a grain is made of.
struct Matter {
    std::uint64_t id;
    std::uint8_t body;
    std::uint64_t particles;
    double mass, volume;  ///< [kg], [m3]
    Point centre, velocity, angular_momentum;
};

void put_grain(ParticleSet& grains, std::size_t i, const Matter& matter, double filling) {
    const double radius = std::cbrt(3 * filling * matter.volume / (4 * std::numbers::pi));
    const double inertia = 0.4 * matter.mass * radius * radius;
    grains.data(field::id)[i] = matter.id;
    grains.data(field::body)[i] = matter.body;
    grains.data(field::particle_count)[i] = matter.particles;
    grains.data(field::mass)[i] = matter.mass;
    grains.data(field::radius)[i] = radius;
    grains.data(field::moment_of_inertia)[i] = inertia;
    for (int a = 0; a < 3; ++a) {
        const auto axis = static_cast<std::size_t>(a);
        grains.data(field::position, a)[i] = matter.centre[axis];
        grains.data(field::velocity, a)[i] = matter.velocity[axis];
        grains.data(field::angular_velocity, a)[i] = matter.angular_momentum[axis] / inertia;
    }
}

Matter single(const ParticleSet& particles, std::size_t i, const HandOffPlan& plan) {
    const double mass = particles.data(field::mass)[i];
    const std::uint8_t body = particles.data(field::body)[i];
    return {particles.data(field::id)[i],
            body,
            1,
            mass,
            mass / plan.density[body],
            vector_at(particles, field::position, i),
            vector_at(particles, field::velocity, i),
            {}};
}

/// The matter of all fragments, those that this rank makes grains of: every one belongs to one rank. Sums
/// over the ranks a few fragments at a time, for exact sums are large.
std::vector<Matter> matter_of(const Communicator& comm, const LinkedParticles& linked,
                              const HandOffPlan& plan) {
    const ParticleSet& set = linked.particles;
    const std::uint64_t* label = set.data(field::fragment);
    std::vector<std::size_t> by_label(linked.fragments.size());
    for (std::size_t k = 0; k < by_label.size(); ++k) by_label[k] = k;
    std::sort(by_label.begin(), by_label.end(), [&](std::size_t a, std::size_t b) {
        return linked.fragments[a].label < linked.fragments[b].label;
    });
    std::vector<std::vector<std::uint32_t>> members(linked.fragments.size());
    for (std::uint32_t i = 0; i < set.size(); ++i)
        members[*std::lower_bound(
                    by_label.begin(), by_label.end(), label[i],
                    [&](std::size_t k, std::uint64_t l) { return linked.fragments[k].label < l; })]
            .push_back(i);

    constexpr std::size_t at_once = 1024, sum_count = 4;  // angular momentum, volume
    const auto ranks = static_cast<std::size_t>(comm.size()), rank = static_cast<std::size_t>(comm.rank());
    std::vector<Matter> mine;
    for (std::size_t begin = 0; begin < members.size(); begin += at_once) {
        const std::size_t end = std::min(members.size(), begin + at_once);
        std::vector<ExactSum> sums((end - begin) * sum_count);
        for (std::size_t k = begin; k < end; ++k)
            for (const std::uint32_t i : members[k]) {
                const double mass = set.data(field::mass)[i];
                const Point turning =
                    cross(minus(vector_at(set, field::position, i), linked.fragments[k].centre),
                          minus(vector_at(set, field::velocity, i), linked.fragments[k].velocity));
                ExactSum* of_fragment = &sums[(k - begin) * sum_count];
                for (std::size_t a = 0; a < 3; ++a) of_fragment[a].add(mass * turning[a]);
                of_fragment[3].add(mass / plan.density[set.data(field::body)[i]]);
            }
        ExactSum::all_reduce(comm, sums);
        for (std::size_t k = begin; k < end; ++k) {
            if (k % ranks != rank) continue;
            const Fragment& fragment = linked.fragments[k];
            const std::span<const ExactSum> of_fragment(&sums[(k - begin) * sum_count], sum_count);
            mine.push_back({fragment.label, fragment.body, fragment.particles, fragment.mass,
                            of_fragment[3].value(), fragment.centre, fragment.velocity,
                            fragment.particles > 1 ? rounded(of_fragment) : Point{}});
        }
    }
    return mine;
}

double change(const Point& before, const Point& after, double size) {
    return size > 0 ? norm(minus(after, before)) / size : 0;
}

}  // namespace

Ledger ledger_of(const Communicator& comm, const ParticleSet& particles) {
    enum Sum { mass_sum, momentum, turning = momentum + 3, size = turning + 3, turning_size, kinetic, count };
    const bool spins = particles.has(field::angular_velocity);
    std::vector<ExactSum> sums(count);
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const double mass = particles.data(field::mass)[i];
        const Point v = vector_at(particles, field::velocity, i), p = times(mass, v);
        const Point orbit = cross(vector_at(particles, field::position, i), p);
        sums[mass_sum].add(mass);
        for (std::size_t a = 0; a < 3; ++a) {
            sums[momentum + a].add(p[a]);
            sums[turning + a].add(orbit[a]);
        }
        sums[size].add(norm(p));
        sums[turning_size].add(norm(orbit));
        sums[kinetic].add(0.5 * dot(p, v));
        if (!spins) continue;
        const Point rate = vector_at(particles, field::angular_velocity, i);
        const Point spin = times(particles.data(field::moment_of_inertia)[i], rate);
        for (std::size_t a = 0; a < 3; ++a) sums[turning + a].add(spin[a]);
        sums[kinetic].add(0.5 * dot(spin, rate));
    }
    ExactSum::all_reduce(comm, sums);
    return {sums[mass_sum].value(), rounded({&sums[momentum], 3}), rounded({&sums[turning], 3}),
            sums[size].value(),     sums[turning_size].value(),    sums[kinetic].value()};
}

HandOff hand_off(const Communicator& comm, const HandOffPlan& plan, const Box& box,
                 const ParticleSet& particles) {
    std::vector<Matter> matter;
    for (std::size_t i = 0; i < particles.size(); ++i)
        if (!plan.groups || !may_link(particles, *plan.groups, i))
            matter.push_back(single(particles, i, plan));
    if (plan.groups) {
        const LinkedParticles linked = link_particles(comm, box, particles, *plan.groups);
        const std::vector<Matter> pieces = matter_of(comm, linked, plan);
        matter.insert(matter.end(), pieces.begin(), pieces.end());
    }
    HandOff result{.grains = ParticleSet("grains", 3)};
    for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
             &field::velocity, &field::mass, &field::radius, &field::angular_velocity,
             &field::moment_of_inertia, &field::body, &field::particle_count})
        result.grains.add(*info);
    result.grains.resize(matter.size());
    for (std::size_t i = 0; i < matter.size(); ++i) put_grain(result.grains, i, matter[i], plan.filling);

    const auto whole = [](const Matter& one) { return one.particles > 1; };
    const auto several = static_cast<std::uint64_t>(std::count_if(matter.begin(), matter.end(), whole));
    result.fragments = comm.all_sum(several);
    result.singles = comm.all_sum(static_cast<std::uint64_t>(matter.size()) - several);
    result.particles = comm.all_sum(static_cast<std::uint64_t>(particles.size()));
    result.before = ledger_of(comm, particles);
    result.after = ledger_of(comm, result.grains);
    std::vector<ExactSum> internal(1);
    for (std::size_t i = 0; i < particles.size(); ++i)
        internal[0].add(particles.data(field::mass)[i] * particles.data(field::internal_energy)[i]);
    ExactSum::all_reduce(comm, internal);
    result.internal_energy = internal[0].value();
    result.overlaps = overlaps_of(comm, result.grains);
    return result;
}

std::string describe(const HandOff& result) {
    const Ledger &before = result.before, &after = result.after;
    std::string text = fmt::format(
        "handed over: {} particles became {} grains, {} of several particles and {} of one; mass changed by "
        "{:.1e} of itself, momentum by {:.1e} and angular momentum by {:.1e} of the sum of their sizes; "
        "kinetic "
        "energy {:.4g} J of {:.4g} J; {:.4g} J of internal energy are left behind",
        result.particles, result.fragments + result.singles, result.fragments, result.singles,
        std::abs(after.mass / before.mass - 1), change(before.momentum, after.momentum, before.momentum_size),
        change(before.angular_momentum, after.angular_momentum, before.turning_size), after.kinetic_energy,
        before.kinetic_energy, result.internal_energy);
    const Overlaps& overlaps = result.overlaps;
    if (overlaps.pairs == 0) return text + "; no grains overlap";
    return text + fmt::format(
                      "; {} pairs of grains overlap, the deepest by {:.4g} m, at most {:.3g} of the "
                      "smaller radius",
                      overlaps.pairs, overlaps.deepest, overlaps.share);
}

}  // namespace talus
