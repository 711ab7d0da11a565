#include <algorithm>

#include "domain/depth_fields.hpp"
#include "domain/two_phase_fields.hpp"
#include "physics/depth/kernel.hpp"
#include "physics/depth/passes.hpp"
#include "physics/sph/pair_records.hpp"
#include "physics/sph/pass_support.hpp"
#include "physics/sph/small_vectors.hpp"

namespace talus::depth {

namespace {

using sph::components;

constexpr double least_change = 0.8, greatest_change = 1.25;  // of the smoothing length in a step

/// What is found beside the height.
enum class Beside : std::uint8_t { nothing, divergence, other_phase };

template <int D, Beside beside>
class HeightPass {
  public:
    HeightPass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings)
        : settings_(settings),
          factor_(lattice_factor<D>(settings)),
          smoothing_length_(particles.data(field::smoothing_length)),
          next_(particles.data(field::next_smoothing_length)),
          height_(particles.data(field::column_height)),
          grad_h_(particles.data(field::grad_h_volume)),
          partners_(components<D>(particles, field::position), smoothing_length_, Settings::support()),
          records_(particles, table, which) {
        partners_.search_by_blocks(particles.size() + (which == Cells::interior ? 0 : particles.halo_size()));
        records_.copy(0, components<D>(particles, field::position));
        records_.copy(place_volume, components<1>(particles, field::volume));
        if constexpr (of_phases) {
            other_height_ = particles.data(field::other_height);
            other_cover_ = particles.data(field::other_cover);
            records_.copy(place_phase, components<1>(particles, field::is_water));
            records_.copy(place_s, components<1>(particles, field::smoothing_length));
        }
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
    static constexpr bool with_divergence = beside == Beside::divergence,
                          of_phases = beside == Beside::other_phase;
    static constexpr std::size_t place_volume = D, place_velocity = D + 1, place_phase = D + 1,
                                 place_s = D + 2,
                                 record_size = with_divergence ? 2 * D + 1
                                               : of_phases     ? D + 3
                                                               : D + 1;
    static constexpr auto as_copied = [](const sph::Neighbours&, auto&) {};
    struct Sums {
        double number, height;                    ///< sum W [1/m^D], sum V W [m]
        double number_dilation, height_dilation;  ///< the same of r dW/dr, negative
        double divergence;                        ///< sum (v_j - v_i) grad W
        double other_height, other_cover;         ///< the height and sum A W of the other phase
    };

    [[gnu::flatten]] Sums sum_over_partners(std::uint32_t i) {
        const auto own = sph::broadcast(records_[i]);
        const Lanes inverse_s = 1 / smoothing_length_[i];
        const std::span<const std::uint32_t> partners = partners_.index();
        LaneSum number, height, number_dilation, height_dilation, divergence, other_height, other_cover;
        for (std::size_t k = 0; k < partners.size(); k += lane_count) {
            const auto other = records_.gather(partners.data() + k);
            sph::Vector<Lanes, D> r;
            for (std::size_t d = 0; d < D; ++d) r[d] = own[d] - other[d];
            const Lanes r2 = sph::dot(r, r);
            LaneMask real = first_lanes(partners.size() - k);
            if constexpr (of_phases) {
                const LaneMask same = own[place_phase] == other[place_phase];
                const Lanes unlike = select(real && !same, kernel_.value(r2, inverse_s), Lanes(0.0));
                other_height.add(k, other[place_volume] * unlike);
                other_cover.add(k, area_of<D>(other[place_s], settings_.eta) * unlike);
                real = real && same;
            }
            const Lanes slope = select(real, kernel_.factor(r2, inverse_s), Lanes(0.0)),
                        value = select(real, kernel_.value(r2, inverse_s), Lanes(0.0));
            number.add(k, value);
            height.add(k, other[place_volume] * value);
            number_dilation.add(k, slope * r2);
            height_dilation.add(k, other[place_volume] * slope * r2);
            if constexpr (with_divergence) {
                Lanes closing = 0;
                for (std::size_t d = 0; d < D; ++d)
                    closing += (other[place_velocity + d] - own[place_velocity + d]) * r[d];
                divergence.add(k, slope * closing);
            }
        }
        return {factor_ * number.total(),          factor_ * height.total(),
                factor_ * number_dilation.total(), factor_ * height_dilation.total(),
                factor_ * divergence.total(),      factor_ * other_height.total(),
                factor_ * other_cover.total()};
    }

    /// Newton's step for sum W(r, s) = (eta/s)^D. By the scaling of kernels s dW/ds = -(D W + r dW/dr).
    void store(std::uint32_t i, const Sums& sums) {
        const double s = smoothing_length_[i], volume = records_[i].values[place_volume];
        const double number = sums.number + own_share(s), height = sums.height + volume * own_share(s);
        double wanted = 1;
        for (int d = 0; d < D; ++d) wanted *= settings_.eta / s;
        const double change = D * (wanted - number) - sums.number_dilation;
        // Far from the solution, among many more than are wanted, the slope has the other sign.
        const double step = change > 0 ? 1 - (number - wanted) / change : least_change;
        const double found = s * std::clamp(step, least_change, greatest_change);
        const double most = settings_.largest_smoothing_length, next = found < most ? found : most;
        const double stretched = D * height + sums.height_dilation;
        next_[i] = next;
        height_[i] = std::max(height - stretched * (next / s - 1), volume * own_share(next));
        // The force between two far from all others would be beyond bounds.
        const double dilation = std::min(sums.number_dilation, -least_grad_h * D * number);
        grad_h_[i] = found < most ? stretched / dilation : 0;
        if constexpr (with_divergence) divergence_[i] = sums.divergence / number;
        if constexpr (of_phases) {
            other_height_[i] = sums.other_height / std::max(sums.other_cover, full_cover);
            other_cover_[i] = sums.other_cover;
        }
    }
    double own_share(double s) const { return factor_ * kernel_.value(0.0, 1 / s); }

    static constexpr double least_grad_h = 0.1;
    const Kernel<D> kernel_{};
    const Settings settings_;
    const double factor_;
    const double* smoothing_length_;
    double *next_, *height_, *grad_h_, *divergence_ = nullptr, *other_height_ = nullptr,
                                       *other_cover_ = nullptr;
    Partners<D> partners_;
    sph::PairRecords<record_size> records_;
};

template <int D, Beside beside>
void run(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings) {
    sph::visit_cells(HeightPass<D, beside>(particles, table, which, settings), table, which);
}

template <int D>
void run(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings) {
    if (settings.earth_pressure)
        run<D, Beside::divergence>(particles, table, which, settings);
    else if (settings.two_phase)
        run<D, Beside::other_phase>(particles, table, which, settings);
    else
        run<D, Beside::nothing>(particles, table, which, settings);
}

}  // namespace

void height_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings) {
    if (particles.dimension() == 1)
        run<1>(particles, table, which, settings);
    else
        run<2>(particles, table, which, settings);
}

}  // namespace talus::depth
