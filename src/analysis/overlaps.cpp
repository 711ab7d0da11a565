#include <algorithm>
#include <cmath>
#include <limits>

#include "comm/decomposition.hpp"
#include "domain/partners.hpp"
#include "src/analysis/hand_off.hpp"
#include "src/analysis/selection.hpp"

namespace talus {

namespace {

/// Grains up to some radius find each other on one grid; those that are larger, at most so many, are compared
/// with all. The radius is the least one by as many steps of `alike` as that takes.
constexpr double alike = 3;
constexpr std::uint64_t most_large = 1000;

struct Sphere {
    std::uint64_t id;
    Point centre;
    double radius;
    std::uint8_t body;  ///< 0 where bodies do not matter
};

Sphere sphere_at(const ParticleSet& grains, std::size_t i) {
    return {grains.data(field::id)[i],
            {grains.data(field::position, 0)[i], grains.data(field::position, 1)[i],
             grains.data(field::position, 2)[i]},
            grains.data(field::radius)[i],
            grains.has(field::body) ? grains.data(field::body)[i] : std::uint8_t{0}};
}

/// Adds a pair, if it overlaps. Pairs are counted in halves.
void look_at(const Sphere& a, const Sphere& b, Between which, std::uint64_t halves, Overlaps& found) {
    if (which == Between::different_bodies && a.body == b.body) return;
    const double overlap = a.radius + b.radius - norm(minus(a.centre, b.centre));
    if (!(overlap > 0)) return;
    found.pairs += halves;
    found.deepest = std::max(found.deepest, overlap);
    found.share = std::max(found.share, overlap / std::min(a.radius, b.radius));
}

/// Each pair is seen from both its grains.
void look_at_small(const Communicator& comm, ParticleSet small, double largest, Between which,
                   Overlaps& found) {
    if (comm.all_sum(static_cast<std::uint64_t>(small.size())) < 2) return;
    Box open;
    open.dimension = 3;
    const CellGrid grid(open, 2 * largest, 1);
    Decomposition decomposition(comm, PartitionMethod::cheapest);
    decomposition.expect(small);
    decomposition.divide(small, grid);
    decomposition.arrange(small, grid);
    decomposition.halo().begin(small, {&field::position, &field::radius, &field::body});
    decomposition.halo().finish();
    Partners<3> partners(
        {small.data(field::position, 0), small.data(field::position, 1), small.data(field::position, 2)},
        small.data(field::radius), 2);
    decomposition.table().for_each_own(
        Cells::all, [&](const CellEntry& cell, std::span<const Run> runs, std::size_t) {
            partners.enter(cell, runs);
            for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
                partners.find_mutual(i, 2);
                for (const std::uint32_t k : partners.index())
                    look_at(sphere_at(small, i), sphere_at(small, k), which, 1, found);
            }
        });
}

}  // namespace

Overlaps overlaps_of(const Communicator& comm, const ParticleSet& grains, Between which) {
    const auto radius = grains.own(field::radius);
    const auto least = std::min_element(radius.begin(), radius.end());
    double small_up_to =
        alike * comm.all_min(least == radius.end() ? std::numeric_limits<double>::infinity() : *least);
    const auto larger = [&] {
        return static_cast<std::uint64_t>(
            std::count_if(radius.begin(), radius.end(), [&](double r) { return r > small_up_to; }));
    };
    while (comm.all_sum(larger()) > most_large) small_up_to *= alike;
    std::vector<std::uint32_t> small;
    std::vector<Sphere> large;
    for (std::uint32_t i = 0; i < grains.size(); ++i) {
        if (radius[i] <= small_up_to)
            small.push_back(i);
        else
            large.push_back(sphere_at(grains, i));
    }
    Overlaps found;
    const FieldInfo* const fields[] = {&field::radius, &field::body};
    look_at_small(comm, selected("grains", grains, small, fields), small_up_to, which, found);
    const std::vector<Sphere> all_large = comm.all_gather(std::span<const Sphere>(large));
    for (const Sphere& one : all_large) {
        for (const std::uint32_t i : small) look_at(one, sphere_at(grains, i), which, 2, found);
        for (const Sphere& mine : large)
            if (mine.id != one.id) look_at(one, mine, which, 1, found);
    }
    return {comm.all_sum(found.pairs) / 2, comm.all_max(found.deepest), comm.all_max(found.share)};
}

}  // namespace talus
