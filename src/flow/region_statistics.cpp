#include "src/flow/region_statistics.hpp"

#include <cmath>
#include <numbers>

#include "comm/exact_sum.hpp"
#include "domain/clump_fields.hpp"
#include "domain/grain_fields.hpp"
#include "physics/dem/shear.hpp"
#include "physics/dem/vectors.hpp"
#include "src/flow/grain_region.hpp"

namespace talus {

namespace {

constexpr std::array<std::array<std::size_t, 2>, 6> stress_axes{
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};

/// The sums of a region, one after the other.
enum Sum : std::size_t {
    mass,
    volume_of_grains,
    momentum,
    flux = momentum + 3,
    virial = flux + 6,
    sum_count = virial + 6
};

/// 1 for each own grain whose centre is in the region, or that of its clump.
std::vector<std::uint8_t> members(const ParticleSet& grains, const Box& box, const dem::ClumpMotion& clumps,
                                  const BodyShape& shape) {
    std::vector<std::uint8_t> inside(grains.size());
    for (std::size_t i = 0; i < grains.size(); ++i)
        inside[i] = contains(shape, place_in_box(grains, i, box, clumps), 3);
    return inside;
}

void add_grains(const ParticleSet& grains, const Box& box, const dem::ClumpMotion& clumps,
                std::span<const std::uint8_t> inside, std::span<ExactSum> sums,
                std::span<std::uint64_t> counts) {
    const double *m = grains.data(field::mass), *r = grains.data(field::radius);
    const std::uint8_t* body = grains.data(field::body);
    for (std::size_t i = 0; i < grains.size(); ++i) {
        if (!inside[i] || !clumps.counts(body[i], grains.data(field::id)[i])) continue;
        ++counts[body[i]];
        const dem::ClumpBody* clump = clumps.of_body(body[i]);
        const Field<double>& velocity = clump ? field::clump_velocity : field::velocity;
        std::array<double, 3> v{};
        for (int axis = 0; axis < 3; ++axis)
            v[static_cast<std::size_t>(axis)] = grains.data(velocity, axis)[i];
        v[0] -= dem::shear_flow(box, grains.data(clump ? field::clump_centre : field::position, 1)[i]);
        sums[mass].add(m[i]);
        sums[volume_of_grains].add(clump ? clump->shape->volume
                                         : 4.0 / 3.0 * std::numbers::pi * r[i] * r[i] * r[i]);
        for (std::size_t a = 0; a < 3; ++a) sums[momentum + a].add(m[i] * v[a]);
        for (std::size_t k = 0; k < 6; ++k)
            sums[flux + k].add(m[i] * v[stress_axes[k][0]] * v[stress_axes[k][1]]);
    }
}

void add_contacts(const ParticleSet& grains, const dem::ClumpMotion& clumps,
                  std::span<const dem::LoadedContact> contacts, std::span<const std::uint8_t> inside,
                  std::span<ExactSum> sums) {
    /// From the centre of the grain or clump to that of the sphere.
    const auto arm_of_sphere = [&](std::size_t i) -> dem::Vector3<> {
        if (!clumps.of_body(grains.data(field::body)[i])) return {};
        return dem::Vectors(grains, field::position)[i] - dem::Vectors(grains, field::clump_centre)[i];
    };
    for (const dem::LoadedContact& contact : contacts) {
        const dem::Vector3<>& force = contact.load.force;
        const std::array<double, 3> f{force.x, force.y, force.z};
        const auto add = [&](std::uint32_t sphere, double arm, double side) {
            if (sphere >= inside.size() || !inside[sphere]) return;  // another rank's, or elsewhere
            const dem::Vector3<> to_centre = arm * contact.normal - side * arm_of_sphere(sphere);
            const std::array<double, 3> r{to_centre.x, to_centre.y, to_centre.z};
            for (std::size_t k = 0; k < 6; ++k) {
                const auto [i, j] = stress_axes[k];
                sums[virial + k].add(0.5 * (r[i] * f[j] + r[j] * f[i]));
            }
        };
        add(contact.first, contact.first_arm, 1);
        if (!contact.at_wall) add(contact.second, contact.second_arm, -1);  // force and normal turn about
    }
}

}  // namespace

std::vector<RegionState> region_states(const Communicator& comm, const ParticleSet& grains, const Box& box,
                                       const dem::ClumpMotion& clumps, std::size_t bodies,
                                       std::span<const WatchedRegion> regions,
                                       std::span<const dem::LoadedContact> contacts) {
    std::vector<ExactSum> all_sums(regions.size() * sum_count);
    std::vector<std::uint64_t> all_counts(regions.size() * bodies);
    for (std::size_t k = 0; k < regions.size(); ++k) {
        const std::vector<std::uint8_t> inside = members(grains, box, clumps, regions[k].shape);
        const std::span<ExactSum> sums = std::span(all_sums).subspan(k * sum_count, sum_count);
        add_grains(grains, box, clumps, inside, sums, std::span(all_counts).subspan(k * bodies, bodies));
        if (regions[k].stress) add_contacts(grains, clumps, contacts, inside, sums);
    }
    ExactSum::all_reduce(comm, all_sums);
    comm.all_sum(std::span<std::uint64_t>(all_counts));
    std::vector<RegionState> states(regions.size());
    for (std::size_t k = 0; k < regions.size(); ++k) {
        RegionState& state = states[k];
        const auto sum = [&](std::size_t which) { return all_sums[k * sum_count + which].value(); };
        const double region_volume = volume(regions[k].shape, 3);
        state.of_body.assign(all_counts.begin() + static_cast<std::ptrdiff_t>(k * bodies),
                             all_counts.begin() + static_cast<std::ptrdiff_t>((k + 1) * bodies));
        for (const std::uint64_t count : state.of_body) state.count += count;
        state.mass = sum(mass);
        state.solid_fraction = sum(volume_of_grains) / region_volume;
        if (state.count == 0) continue;
        for (std::size_t a = 0; a < 3; ++a) state.velocity[a] = sum(momentum + a) / state.mass;
        for (std::size_t c = 0; c < 6; ++c) {
            const auto [i, j] = stress_axes[c];
            const double kinetic = sum(flux + c) - state.mass * state.velocity[i] * state.velocity[j];
            state.stress[c] = (kinetic + sum(virial + c)) / region_volume;
        }
    }
    return states;
}

}  // namespace talus
