#include <cmath>
#include <numbers>

#include "physics/sph/pair_records.hpp"
#include "physics/sph/pass_support.hpp"
#include "physics/sph/passes.hpp"
#include "physics/sph/small_vectors.hpp"

namespace talus::sph {

namespace {

/// Share of a particle's own term in its density, for an even spread with h = eta spacings.
template <int D, class Kernel>
double own_share(const Kernel& kernel, double eta) {
    constexpr double unit_ball = D == 1 ? 2.0 : D == 2 ? std::numbers::pi : 4.0 / 3 * std::numbers::pi;
    return 1 - Kernel::self_excess(unit_ball * std::pow(kernel.support() * eta, D));
}

/// sum_j m_j W(r_ij, h) over partners within the kernel's support and the particle itself, less what an even
/// spread of particles makes too much.
template <int D, class Kernel>
class DensitySum {
  public:
    DensitySum(const ParticleSet& particles, const CellTable& table, Cells which, const Kernel& kernel,
               double widest)
        : kernel_(kernel),
          h_(particles.data(field::smoothing_length)),
          partners_(components<D>(particles, field::position), h_, kernel.support() * widest),
          records_(particles, table, which) {
        records_.copy(0, components<D>(particles, field::position));
        records_.copy(place_mass, components<1>(particles, field::mass));
        records_.fill_copies(as_copied);
    }

    void enter(const CellEntry& cell, std::span<const Run> runs) {
        partners_.enter(cell, runs);
        records_.enter(runs, as_copied);
    }
    /// With the kernel of `widening` h; `own_share`: of the particle's own term.
    [[gnu::flatten]] double operator()(std::uint32_t i, double widening, double own_share) {
        const double inverse_h = 1 / (widening * h_[i]);
        partners_.find(i, kernel_.support() * widening);
        const auto own = broadcast(records_[i]);
        const std::span<const std::uint32_t> partners = partners_.index();
        LaneSum total;
        for (std::size_t k = 0; k < partners.size(); k += lane_count) {
            const auto other = records_.gather(partners.data() + k);
            Vector<Lanes, D> r;
            for (std::size_t d = 0; d < D; ++d) r[d] = own[d] - other[d];
            const Lanes value = kernel_.value(dot(r, r), Lanes(inverse_h));
            total.add(k, select(first_lanes(partners.size() - k), other[place_mass] * value, Lanes(0.0)));
        }
        return total.total() + own_share * records_[i].values[place_mass] * kernel_.value(0.0, inverse_h);
    }

  private:
    static constexpr std::size_t place_mass = D;
    static constexpr auto as_copied = [](const Neighbours&, auto&) {};

    const Kernel kernel_;
    const double* h_;
    Partners<D> partners_;
    PairRecords<D + 1> records_;
};

template <int D, class Kernel>
void run(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
         const Kernel& kernel) {
    const double widening = settings.smoothing_widening;
    DensitySum<D, Kernel> sum(particles, table, which, kernel, std::max(1.0, widening));
    const double share = own_share<D>(kernel, settings.eta),
                 widened_share = own_share<D>(kernel, widening * settings.eta);
    const double* mass = particles.data(field::mass);
    double* density = particles.data(field::predicted_density);
    double* next_h =
        settings.variable_smoothing_length ? particles.data(field::next_smoothing_length) : nullptr;
    table.for_each_own(which, [&](const CellEntry& cell, std::span<const Run> runs, std::size_t) {
        sum.enter(cell, runs);
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            const bool summed = settings.density == DensityMethod::summation;
            if (summed) density[i] = sum(i, 1, share);
            if (!next_h) continue;
            const double smoothed = summed && widening == 1 ? density[i] : sum(i, widening, widened_share);
            next_h[i] = settings.eta * std::pow(mass[i] / smoothed, 1.0 / D);
            if (settings.largest_smoothing_length > 0)
                next_h[i] = std::min(next_h[i], settings.largest_smoothing_length);
        }
    });
}

}  // namespace

void density_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings) {
    with_dimension(particles, [&](auto dimension) {
        constexpr int D = dimension;
        with_kernel<D>(settings,
                       [&](const auto& kernel) { run<D>(particles, table, which, settings, kernel); });
    });
}

}  // namespace talus::sph
