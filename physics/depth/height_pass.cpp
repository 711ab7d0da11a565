#include <algorithm>

#include "domain/depth_fields.hpp"
#include "physics/depth/kernel.hpp"
#include "physics/depth/passes.hpp"
#include "physics/sph/pair_records.hpp"
#include "physics/sph/pass_support.hpp"
#include "physics/sph/small_vectors.hpp"

namespace talus::depth {

namespace {

using sph::components;

constexpr double least_change = 0.8, greatest_change = 1.25;  // of the smoothing length in a step

template <int D, bool with_divergence>
class HeightPass {
  public:
    HeightPass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings)
        : settings_(settings),
          factor_(lattice_factor<D>(settings)),
          smoothing_length_(particles.data(field::smoothing_length)),
          next_(particles.data(field::next_smoothing_length)),
          height_(particles.data(field::column_height)),
          grad_h_(particles.data(field::grad_h_factor)),
          partners_(components<D>(particles, field::position), smoothing_length_, Settings::support()),
          records_(particles, table, which) {
        records_.copy(0, components<D>(particles, field::position));
        records_.copy(place_volume, components<1>(particles, field::volume));
        if constexpr (with_divergence) {
            divergence_ = particles.data(field::divergence);
            records_.copy(place_velocity, components<D>(particles, field::predicted_velocity));
        }
        records_.fill_copies(as_copied);
    }

    void visit(const CellEntry& cell, std::span<const Run> runs) {
        partners_.enter(cell, runs);
        records_.enter(runs, as_copied);
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            partners_.find(i, Settings::support());
            store(i, sum_over_partners(i));
        }
    }

  private:
    static constexpr std::size_t place_volume = D, place_velocity = D + 1,
                                 record_size = with_divergence ? 2 * D + 1 : D + 1;
    static constexpr auto as_copied = [](const sph::Neighbours&, auto&) {};
    struct Sums {
        double height;      ///< sum V W [m]
        double dilation;    ///< sum V r dW/dr, negative [m]
        double divergence;  ///< sum V (v_j - v_i) grad W [m/s]
    };

    [[gnu::flatten]] Sums sum_over_partners(std::uint32_t i) {
        const auto own = sph::broadcast(records_[i]);
        const Lanes inverse_s = 1 / smoothing_length_[i];
        const std::span<const std::uint32_t> partners = partners_.index();
        LaneSum height, dilation, divergence;
        for (std::size_t k = 0; k < partners.size(); k += lane_count) {
            const auto other = records_.gather(partners.data() + k);
            sph::Vector<Lanes, D> r;
            for (std::size_t d = 0; d < D; ++d) r[d] = own[d] - other[d];
            const Lanes r2 = sph::dot(r, r);
            const Lanes volume = select(first_lanes(partners.size() - k), other[place_volume], Lanes(0.0));
            const Lanes slope = volume * kernel_.factor(r2, inverse_s);
            height.add(k, volume * kernel_.value(r2, inverse_s));
            dilation.add(k, slope * r2);
            if constexpr (with_divergence) {
                Lanes closing = 0;
                for (std::size_t d = 0; d < D; ++d)
                    closing += (other[place_velocity + d] - own[place_velocity + d]) * r[d];
                divergence.add(k, slope * closing);
            }
        }
        return {factor_ * height.total(), factor_ * dilation.total(), factor_ * divergence.total()};
    }

    /// Newton's step for sum V W(r, s) = V (eta/s)^D. By the scaling of kernels s dW/ds = -(D W + r dW/dr).
    void store(std::uint32_t i, const Sums& sums) {
        const double s = smoothing_length_[i], volume = records_[i].values[place_volume];
        const double height = sums.height + own_share(volume, s);
        const double wanted = height_at(volume, s), change = D * (wanted - height) - sums.dilation;
        const double step = change > 0 ? 1 - (height - wanted) / change : greatest_change;
        const double next = s * std::clamp(step, least_change, greatest_change);
        const double most = settings_.largest_smoothing_length;
        next_[i] = next < most ? next : most;
        if (next < most) {
            height_[i] = height_at(volume, next);
            // An isolated column has no partner to lose: then nothing depends on the factor.
            grad_h_[i] = std::max(-sums.dilation / (D * height), least_grad_h);
        } else {
            const double grown = height - (D * height + sums.dilation) * (most / s - 1);
            height_[i] = std::max(grown, own_share(volume, most));
            grad_h_[i] = 1;
        }
        if constexpr (with_divergence) divergence_[i] = sums.divergence / height;
    }
    double own_share(double volume, double s) const { return factor_ * volume * kernel_.value(0.0, 1 / s); }
    double height_at(double volume, double s) const {
        double ratio = volume;
        for (int d = 0; d < D; ++d) ratio *= settings_.eta / s;
        return ratio;
    }

    static constexpr double least_grad_h = 0.1;
    const Kernel<D> kernel_{};
    const Settings settings_;
    const double factor_;
    const double* smoothing_length_;
    double *next_, *height_, *grad_h_, *divergence_ = nullptr;
    Partners<D> partners_;
    sph::PairRecords<record_size> records_;
};

template <int D, bool with_divergence>
void run(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings) {
    HeightPass<D, with_divergence> pass(particles, table, which, settings);
    table.for_each_own(which, [&pass](const CellEntry& cell, std::span<const Run> runs, std::size_t) {
        pass.visit(cell, runs);
    });
}

template <int D>
void run(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings) {
    if (settings.needs_divergence())
        run<D, true>(particles, table, which, settings);
    else
        run<D, false>(particles, table, which, settings);
}

}  // namespace

void height_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings) {
    if (particles.dimension() == 1)
        run<1>(particles, table, which, settings);
    else
        run<2>(particles, table, which, settings);
}

}  // namespace talus::depth
