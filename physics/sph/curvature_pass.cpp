#include "physics/sph/pass_support.hpp"
#include "physics/sph/passes.hpp"
#include "physics/sph/small_tensors.hpp"

namespace talus::sph {

namespace {

template <int D>
void run(ParticleSet& particles, const CellTable& table, Cells which, const Gaussian<D>& kernel) {
    const auto position = components<D>(particles, field::position);
    const auto gradient = components<D>(particles, field::volume_gradient);
    const double *mass = particles.data(field::mass), *density = particles.data(field::predicted_density);
    const double* smoothing_length = particles.data(field::smoothing_length);
    const auto curvature = components_to_write<symmetric_count<D>>(particles, field::volume_curvature);
    Partners<D> partners(position, smoothing_length, kernel.support());
    table.for_each_own(which, [&](const CellEntry& cell, std::span<const Run> runs, std::size_t) {
        partners.enter(cell, runs);
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            const double inverse_h = 1 / smoothing_length[i];
            partners.find(i, kernel.support());
            std::array<double, symmetric_count<D>> sum{};
            for (const std::uint32_t j : partners.index()) {
                std::array<double, D> r;
                double r2 = 0;
                for (int d = 0; d < D; ++d) {
                    r[d] = position[d][i] - position[d][j];
                    r2 += r[d] * r[d];
                }
                const double weight = mass[j] / density[j] * kernel.factor(r2, inverse_h);
                for (int a = 0; a < D; ++a)
                    for (int b = a; b < D; ++b)
                        sum[symmetric_index<D>(a, b)] +=
                            0.5 * weight * (gradient[a][j] * r[b] + gradient[b][j] * r[a]);
            }
            for (int c = 0; c < symmetric_count<D>; ++c) curvature[c][i] = sum[c];
        }
    });
}

}  // namespace

void curvature_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings) {
    with_dimension(particles, [&](auto dimension) {
        run<dimension>(particles, table, which, Gaussian<dimension>(settings.cutoff));
    });
}

}  // namespace talus::sph
