#include "src/setup/shrink_grains.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "comm/decomposition.hpp"
#include "domain/boundary.hpp"
#include "domain/fields.hpp"
#include "domain/partners.hpp"

namespace talus {

Shrunk shrink_overlapping(const Communicator& comm, const Box& box, ParticleSet& grains) {
    double largest = 0;
    for (const double r : std::as_const(grains).own(field::radius)) largest = std::max(largest, r);
    const CellGrid grid(box, 2 * comm.all_max(largest), 1);
    apply_boundaries(grains, box);
    Decomposition decomposition(comm, PartitionMethod::cheapest);
    decomposition.expect(grains);
    decomposition.divide(grains, grid);
    decomposition.arrange(grains, grid);
    decomposition.halo().begin(grains, {&field::position, &field::radius});
    decomposition.halo().finish();

    double* radius = grains.data(field::radius);
    const std::array<const double*, 3> x{grains.data(field::position, 0), grains.data(field::position, 1),
                                         grains.data(field::position, 2)};
    std::vector<double> factors(grains.size(), 1.0);
    Partners<3> partners(x, radius, 2);
    decomposition.table().for_each_own(
        Cells::all, [&](const CellEntry& cell, std::span<const Run> runs, std::size_t) {
            partners.enter(cell, runs);
            for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
                partners.find_mutual(i, 2);
                for (const std::uint32_t k : partners.index()) {
                    if (k == i) continue;
                    double distance2 = 0;
                    for (const double* along : x) distance2 += (along[i] - along[k]) * (along[i] - along[k]);
                    factors[i] = std::min(factors[i], std::sqrt(distance2) / (radius[i] + radius[k]));
                }
            }
        });
    Shrunk result;
    std::uint64_t id = std::numeric_limits<std::uint64_t>::max();
    for (std::size_t i = 0; i < grains.size(); ++i) {
        if (!(factors[i] < 1)) continue;
        ++result.grains;
        if (factors[i] < result.least) id = grains.data(field::id)[i];
        result.least = std::min(result.least, factors[i]);
        radius[i] *= factors[i];
        for (int axis = 0; axis < 3; ++axis)
            grains.data(field::angular_velocity, axis)[i] /= factors[i] * factors[i];
    }
    const double mine = result.least;
    result.grains = comm.all_sum(result.grains);
    result.least = comm.all_min(mine);
    result.id = comm.all_min(mine == result.least ? id : std::numeric_limits<std::uint64_t>::max());
    return result;
}

}  // namespace talus
