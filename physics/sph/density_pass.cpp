#include <cmath>
#include <numbers>

#include "physics/sph/pass_support.hpp"
#include "physics/sph/passes.hpp"

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
    DensitySum(const ParticleSet& particles, const Kernel& kernel, double widest)
        : kernel_(kernel),
          position_(components<D>(particles, field::position)),
          mass_(particles.data(field::mass)),
          h_(particles.data(field::smoothing_length)),
          partners_(position_, h_, kernel.support() * widest) {}

    void enter(const CellEntry& cell, std::span<const Run> runs) { partners_.enter(cell, runs); }
    /// With the kernel of `widening` h; `own_share`: of the particle's own term.
    double operator()(std::uint32_t i, double widening, double own_share) {
        const double inverse_h = 1 / (widening * h_[i]);
        partners_.find(i, kernel_.support() * widening);
        x_.gather(partners_, position_);
        partners_.gather(mass_, m_);
        const auto x = x_.data();
        const double* m = m_.data();
        std::array<double, D> x_i;
        for (int d = 0; d < D; ++d) x_i[d] = position_[d][i];
        const Kernel kernel = kernel_;
        double total = 0;
#pragma omp simd reduction(+ : total)
        for (std::size_t k = 0; k < partners_.count(); ++k) {
            double r2 = 0;
            for (int d = 0; d < D; ++d) r2 += (x_i[d] - x[d][k]) * (x_i[d] - x[d][k]);
            total += m[k] * kernel.value(r2, inverse_h);
        }
        return total + own_share * mass_[i] * kernel_.value(0.0, inverse_h);
    }

  private:
    const Kernel kernel_;
    std::array<const double*, D> position_;
    const double *mass_, *h_;
    Partners<D> partners_;
    PartnerValues<D> x_;
    AlignedValues m_;
};

template <int D, class Kernel>
void run(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
         const Kernel& kernel) {
    const double widening = settings.smoothing_widening;
    DensitySum<D, Kernel> sum(particles, kernel, std::max(1.0, widening));
    const double share = own_share<D>(kernel, settings.eta),
                 widened_share = own_share<D>(kernel, widening * settings.eta);
    const double* mass = particles.data(field::mass);
    double* density = particles.data(field::predicted_density);
    double* next_h =
        settings.variable_smoothing_length ? particles.data(field::next_smoothing_length) : nullptr;
    table.for_each_own(which, [&](const CellEntry& cell, std::span<const Run> runs, std::size_t) {
        sum.enter(cell, runs);
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            if (settings.density == DensityMethod::summation) density[i] = sum(i, 1, share);
            if (!next_h) continue;
            const double smoothed = sum(i, widening, widened_share);
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
