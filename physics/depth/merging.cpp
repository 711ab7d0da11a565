#include "physics/depth/merging.hpp"

#include "domain/depth_fields.hpp"
#include "domain/merging_fields.hpp"
#include "domain/partners.hpp"
#include "physics/sph/pass_support.hpp"

namespace talus::depth {

namespace {

template <int D>
std::vector<std::uint32_t> nearest_of(ParticleSet& particles, const CellTable& table,
                                      const Settings& settings) {
    const double distance = settings.merging_distance;
    const double* s = particles.data(field::smoothing_length);
    std::vector<double> radius(particles.size_with_halo());  // 0 where columns do not crowd
    for (std::size_t i = 0; i < radius.size(); ++i) radius[i] = s[i] < settings.eta * distance ? distance : 0;
    const auto x = sph::components<D>(particles, field::position);
    const std::uint64_t* id = particles.data(field::known_id);
    std::uint64_t* nearest_id = particles.data(field::nearest_column);
    std::vector<std::uint32_t> nearest(particles.size());
    Partners<D> partners(x, radius.data(), 1);
    partners.search_by_blocks(particles.size_with_halo());
    table.for_each_own(Cells::all, [&](const CellEntry& cell, std::span<const Run> runs, std::size_t) {
        partners.enter(cell, runs);
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            nearest[i] = i;
            nearest_id[i] = id[i];
            if (radius[i] == 0) continue;  // a cell of such columns alone has no candidates
            partners.find(i, 1);
            double least = distance * distance;
            for (const std::uint32_t j : partners.index()) {
                double r2 = 0;
                for (std::size_t d = 0; d < D; ++d) r2 += (x[d][i] - x[d][j]) * (x[d][i] - x[d][j]);
                if (radius[j] == 0 || r2 > least || (r2 == least && id[j] > id[nearest[i]])) continue;
                least = r2;
                nearest[i] = j;
            }
            nearest_id[i] = id[nearest[i]];
        }
    });
    return nearest;
}

}  // namespace

std::vector<std::uint32_t> find_nearest(ParticleSet& particles, const CellTable& table,
                                        const Settings& settings) {
    return particles.dimension() == 1 ? nearest_of<1>(particles, table, settings)
                                      : nearest_of<2>(particles, table, settings);
}

std::vector<std::uint32_t> merge(ParticleSet& particles, const std::vector<std::uint32_t>& nearest) {
    const std::uint64_t *id = particles.data(field::known_id),
                        *wanted = particles.data(field::nearest_column);
    double* volume = particles.data(field::volume);
    std::vector<std::uint32_t> kept;
    for (std::uint32_t i = 0; i < nearest.size(); ++i) {
        const std::uint32_t j = nearest[i];
        const bool is_pair = j != i && wanted[j] == id[i];
        if (is_pair && id[j] < id[i]) continue;
        kept.push_back(i);
        if (!is_pair) continue;
        const double all = volume[i] + volume[j], share = volume[j] / all;
        for (int axis = 0; axis < particles.dimension(); ++axis) {
            double *x = particles.data(field::position, axis), *v = particles.data(field::velocity, axis);
            x[i] += share * (x[j] - x[i]);
            v[i] += share * (particles.data(field::predicted_velocity, axis)[j] - v[i]);
        }
        volume[i] = all;
    }
    return kept;
}

}  // namespace talus::depth
