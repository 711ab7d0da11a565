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

/// Means over the columns of each phase around, all with the kernel of the column that asks, or that of the
/// partner if it is wider: what is left of their difference is no error of the mean, and columns that stand
/// closely find those of the other phase between which they stand.
template <int D>
class RelativeVelocityPass {
  public:
    RelativeVelocityPass(ParticleSet& particles, const CellTable& table, Cells which,
                         const Settings& settings, double time)
        : settings_(settings),
          time_(time),
          smoothing_length_(particles.data(field::smoothing_length)),
          relative_velocity_(sph::components_to_write<D>(particles, field::relative_velocity)),
          exchange_(particles.data(field::exchange)),
          partners_(components<D>(particles, field::position), smoothing_length_, Settings::support()),
          records_(particles, table, which) {
        partners_.search_by_blocks(particles.size() + (which == Cells::interior ? 0 : particles.halo_size()));
        records_.copy(0, components<D>(particles, field::position));
        records_.copy(place_velocity, components<D>(particles, field::predicted_velocity));
        records_.copy(place_volume, components<1>(particles, field::volume));
        records_.copy(place_phase, components<1>(particles, field::is_water));
        records_.copy(place_inverse_s, components<1>(particles, field::smoothing_length));
        records_.fill_copies(finish);
    }

    void visit(const CellEntry& cell, std::span<const Run> runs) {
        partners_.enter(cell, runs);
        records_.enter(runs, finish);
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            partners_.find_mutual(i, Settings::support());
            evaluate(i);
        }
    }

  private:
    static constexpr std::size_t place_velocity = D, place_volume = 2 * D, place_phase = 2 * D + 1,
                                 place_inverse_s = 2 * D + 2, record_size = 2 * D + 3;
    static constexpr auto finish = [](const sph::Neighbours&, auto& values) {
        values[place_inverse_s] = 1 / values[place_inverse_s];
    };

    [[gnu::flatten]] void evaluate(std::uint32_t i) {
        const auto own = sph::broadcast(records_[i]);
        const auto& mine = records_[i].values;
        const std::span<const std::uint32_t> partners = partners_.index();
        LaneSum own_height, other_height;
        std::array<LaneSum, D> own_flux{}, other_flux{};
        for (std::size_t k = 0; k < partners.size(); k += lane_count) {
            const auto other = records_.gather(partners.data() + k);
            sph::Vector<Lanes, D> r;
            for (std::size_t d = 0; d < D; ++d) r[d] = own[d] - other[d];
            const Lanes inverse_s = min(own[place_inverse_s], other[place_inverse_s]);
            const Lanes weight =
                select(first_lanes(partners.size() - k),
                       other[place_volume] * kernel_.value(sph::dot(r, r), inverse_s), Lanes(0.0));
            const Lanes same = select(own[place_phase] == other[place_phase], weight, Lanes(0.0)),
                        unlike = weight - same;
            own_height.add(k, same);
            other_height.add(k, unlike);
            for (std::size_t d = 0; d < D; ++d) {
                own_flux[d].add(k, same * other[place_velocity + d]);
                other_flux[d].add(k, unlike * other[place_velocity + d]);
            }
        }
        const double self = mine[place_volume] * kernel_.value(0.0, 1 / smoothing_length_[i]),
                     here = self + own_height.total(), there = other_height.total();
        const bool is_water = mine[place_phase] != 0;
        for (std::size_t d = 0; d < D; ++d) {
            const double own_mean = (self * mine[place_velocity + d] + own_flux[d].total()) / here,
                         past = there > 0 ? other_flux[d].total() / there - own_mean : 0;
            relative_velocity_[d][i] = is_water ? -past : past;
        }
        exchange_[i] = there > 0 ? exchanged(is_water ? there : here, is_water ? here : there) : 0;
    }

    /// Of an implicit step: the relative velocity falls by the factor 1/(1 + time (1/(rho_s h_s) + 1/(rho_w
    /// h_w)) C h).
    double exchanged(double solid_sum, double water_sum) const {
        const TwoPhase& phases = *settings_.two_phase;
        const double solid = factor_ * solid_sum, water = factor_ * water_sum;
        const double step = time_ * phases.drag_factor(solid, water, settings_.gravity);
        const double inertia = (phases.solid_density * solid + phases.water_density * water) /
                               (phases.solid_density * phases.water_density);
        return step / (1 + step * inertia);
    }

    const Kernel<D> kernel_{};
    const Settings settings_;
    const double time_, factor_ = lattice_factor<D>(settings_);
    const double* smoothing_length_;
    std::array<double*, D> relative_velocity_;
    double* exchange_;
    Partners<D> partners_;
    sph::PairRecords<record_size> records_;
};

/// What one of a pair gains the other loses. The lesser exchange of the two: no column can be pushed past the
/// velocity of the others.
template <int D>
class DragPass {
  public:
    DragPass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings)
        : settings_(settings),
          velocity_(sph::components_to_write<D>(particles, field::velocity)),
          partners_(components<D>(particles, field::position), particles.data(field::smoothing_length),
                    Settings::support()),
          records_(particles, table, which) {
        partners_.search_by_blocks(particles.size() + (which == Cells::interior ? 0 : particles.halo_size()));
        records_.copy(0, components<D>(particles, field::position));
        records_.copy(place_relative, components<D>(particles, field::relative_velocity));
        records_.copy(place_velocity, components<D>(particles, field::predicted_velocity));
        records_.copy(place_volume, components<1>(particles, field::volume));
        records_.copy(place_phase, components<1>(particles, field::is_water));
        records_.copy(place_exchange, components<1>(particles, field::exchange));
        records_.copy(place_inverse_s, components<1>(particles, field::smoothing_length));
        records_.fill_copies(finish);
    }

    void visit(const CellEntry& cell, std::span<const Run> runs) {
        partners_.enter(cell, runs);
        records_.enter(runs, finish);
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            partners_.find_mutual(i, Settings::support());
            evaluate(i);
        }
    }

  private:
    static constexpr std::size_t place_relative = D, place_velocity = 2 * D, place_volume = 3 * D,
                                 place_phase = 3 * D + 1, place_exchange = 3 * D + 2,
                                 place_inverse_s = 3 * D + 3, record_size = 3 * D + 4;
    /// Of the velocity between two columns themselves; the rest of the drag is that between the means around
    /// them. Means leave alone what differs from column to column; all of it would be a viscosity where drag
    /// is strong.
    static constexpr double own_share = 0.3;
    static constexpr auto finish = [](const sph::Neighbours&, auto& values) {
        values[place_inverse_s] = 1 / values[place_inverse_s];
    };

    [[gnu::flatten]] void evaluate(std::uint32_t i) {
        const auto own = sph::broadcast(records_[i]);
        const bool is_water = records_[i].values[place_phase] != 0;
        const std::span<const std::uint32_t> partners = partners_.index();
        std::array<LaneSum, D> gain{};
        for (std::size_t k = 0; k < partners.size(); k += lane_count) {
            const auto other = records_.gather(partners.data() + k);
            sph::Vector<Lanes, D> r;
            for (std::size_t d = 0; d < D; ++d) r[d] = own[d] - other[d];
            const Lanes r2 = sph::dot(r, r);
            const Lanes mean =
                0.5 * (kernel_.value(r2, own[place_inverse_s]) + kernel_.value(r2, other[place_inverse_s]));
            const Lanes unlike =
                select(own[place_phase] == other[place_phase], Lanes(0.0),
                       other[place_volume] * mean * min(own[place_exchange], other[place_exchange]));
            const Lanes weight = select(first_lanes(partners.size() - k), unlike, Lanes(0.0));
            for (std::size_t d = 0; d < D; ++d) {
                const Lanes of_means = 0.5 * (own[place_relative + d] + other[place_relative + d]),
                            between = own[place_velocity + d] - other[place_velocity + d];
                gain[d].add(
                    k, weight * ((1 - own_share) * of_means + (is_water ? own_share : -own_share) * between));
            }
        }
        const double share = factor_ / settings_.two_phase->density(is_water);
        for (std::size_t d = 0; d < D; ++d)
            velocity_[d][i] += is_water ? -share * gain[d].total() : share * gain[d].total();
    }

    const Kernel<D> kernel_{};
    const Settings settings_;
    const double factor_ = lattice_factor<D>(settings_);
    std::array<double*, D> velocity_;
    Partners<D> partners_;
    sph::PairRecords<record_size> records_;
};

}  // namespace

void relative_velocity_pass(ParticleSet& particles, const CellTable& table, Cells which,
                            const Settings& settings, double time) {
    if (particles.dimension() == 1)
        sph::visit_cells(RelativeVelocityPass<1>(particles, table, which, settings, time), table, which);
    else
        sph::visit_cells(RelativeVelocityPass<2>(particles, table, which, settings, time), table, which);
}

void drag_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings) {
    if (particles.dimension() == 1)
        sph::visit_cells(DragPass<1>(particles, table, which, settings), table, which);
    else
        sph::visit_cells(DragPass<2>(particles, table, which, settings), table, which);
}

}  // namespace talus::depth
