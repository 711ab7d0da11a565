#include <cmath>

#include "domain/depth_fields.hpp"
#include "domain/two_phase_fields.hpp"
#include "physics/depth/kernel.hpp"
#include "physics/depth/motion.hpp"
#include "physics/depth/passes.hpp"
#include "physics/sph/pair_records.hpp"
#include "physics/sph/pass_support.hpp"
#include "physics/sph/small_vectors.hpp"

namespace talus::depth {

namespace {

using sph::components;

constexpr auto as_copied = [](const sph::Neighbours&, auto&) {};

/// A volume that joins a column shares its momentum.
template <int D>
void take_up(const std::array<double*, D>& velocity, double* volume, std::uint32_t i, double taken) {
    const double before = volume[i];
    volume[i] += taken;
    for (double* component : velocity) component[i] *= before / volume[i];
}

template <int D>
class ErosionPass {
  public:
    ErosionPass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
                double time)
        : settings_(settings),
          time_(time),
          velocity_(sph::components_to_write<D>(particles, field::velocity)),
          volume_(particles.data(field::volume)),
          released_(particles.data(field::released_water)),
          height_(particles.data(field::column_height)),
          other_height_(particles.data(field::other_height)),
          smoothing_length_(particles.data(field::smoothing_length)),
          partners_(components<D>(particles, field::position), smoothing_length_, Settings::support()),
          records_(particles, table, which) {
        if (settings.form == Form::bed_fitted) slope_ = components<D>(particles, field::bed_slope);
        partners_.search_by_blocks(particles.size() + (which == Cells::interior ? 0 : particles.halo_size()));
        records_.copy(0, components<D>(particles, field::position));
        records_.copy(place_volume, components<1>(particles, field::volume));
        records_.copy(place_phase, components<1>(particles, field::is_water));
        records_.fill_copies(as_copied);
    }

    void visit(const CellEntry& cell, std::span<const Run> runs) {
        partners_.enter(cell, runs);
        records_.enter(runs, as_copied);
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            released_[i] = 0;
            if (records_[i].values[place_phase] != 0) continue;
            partners_.find(i, Settings::support());
            erode(i, water_around(i));
        }
    }

  private:
    static constexpr std::size_t place_volume = D, place_phase = D + 1, record_size = D + 2;

    [[gnu::flatten]] double water_around(std::uint32_t i) {
        const auto own = sph::broadcast(records_[i]);
        const Lanes inverse_s = 1 / smoothing_length_[i];
        const std::span<const std::uint32_t> partners = partners_.index();
        LaneSum sum;
        for (std::size_t k = 0; k < partners.size(); k += lane_count) {
            const auto other = records_.gather(partners.data() + k);
            sph::Vector<Lanes, D> r;
            for (std::size_t d = 0; d < D; ++d) r[d] = own[d] - other[d];
            const LaneMask counts =
                first_lanes(partners.size() - k) && !(other[place_phase] == own[place_phase]);
            sum.add(k, select(counts, other[place_volume] * kernel_.value(sph::dot(r, r), inverse_s),
                              Lanes(0.0)));
        }
        return sum.total();
    }

    void erode(std::uint32_t i, double water) {
        const TwoPhase& phases = *settings_.two_phase;
        const double held = phases.bed_saturation * phases.bed_porosity;
        if (held > 0 && !(water > 0)) return;
        const double ground = volume_[i] * (1 + other_height_[i] / height_[i]) *
                              std::expm1(settings_.entrainment * speed(i) * time_);
        if (held > 0) released_[i] = held * ground / water;
        take_up<D>(velocity_, volume_, i, (1 - phases.bed_porosity) * ground);
    }

    /// Along the bed.
    double speed(std::uint32_t i) const {
        double speed2 = 0, rise = 0;
        for (std::size_t d = 0; d < D; ++d) {
            speed2 += velocity_[d][i] * velocity_[d][i];
            if (slope_[d]) rise += slope_[d][i] * velocity_[d][i];
        }
        return std::sqrt(speed2 + rise * rise);
    }

    const Kernel<D> kernel_{};
    const Settings settings_;
    const double time_;
    std::array<double*, D> velocity_;
    double *volume_, *released_;
    const double *height_, *other_height_, *smoothing_length_;
    std::array<const double*, D> slope_{};
    Partners<D> partners_;
    sph::PairRecords<record_size> records_;
};

template <int D>
class ReleasePass {
  public:
    ReleasePass(ParticleSet& particles, const CellTable& table, Cells which)
        : velocity_(sph::components_to_write<D>(particles, field::velocity)),
          volume_(particles.data(field::volume)),
          partners_(components<D>(particles, field::position), particles.data(field::smoothing_length),
                    Settings::support()),
          records_(particles, table, which) {
        partners_.search_by_blocks(particles.size() + (which == Cells::interior ? 0 : particles.halo_size()));
        records_.copy(0, components<D>(particles, field::position));
        records_.copy(place_phase, components<1>(particles, field::is_water));
        records_.copy(place_released, components<1>(particles, field::released_water));
        records_.copy(place_inverse_s, components<1>(particles, field::smoothing_length));
        records_.fill_copies(finish);
    }

    void visit(const CellEntry& cell, std::span<const Run> runs) {
        partners_.enter(cell, runs);
        records_.enter(runs, finish);
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            if (records_[i].values[place_phase] == 0) continue;
            partners_.find_mutual(i, Settings::support());
            gather(i);
        }
    }

  private:
    static constexpr std::size_t place_phase = D, place_released = D + 1, place_inverse_s = D + 2,
                                 record_size = D + 3;
    static constexpr auto finish = [](const sph::Neighbours&, auto& values) {
        values[place_inverse_s] = 1 / values[place_inverse_s];
    };

    [[gnu::flatten]] void gather(std::uint32_t i) {
        const auto own = sph::broadcast(records_[i]);
        const std::span<const std::uint32_t> partners = partners_.index();
        LaneSum sum;
        for (std::size_t k = 0; k < partners.size(); k += lane_count) {
            const auto other = records_.gather(partners.data() + k);
            sph::Vector<Lanes, D> r;
            for (std::size_t d = 0; d < D; ++d) r[d] = own[d] - other[d];
            const Lanes found =  // released_water is that of solid alone
                other[place_released] * kernel_.value(sph::dot(r, r), other[place_inverse_s]);
            sum.add(k, select(first_lanes(partners.size() - k), found, Lanes(0.0)));
        }
        take_up<D>(velocity_, volume_, i, volume_[i] * sum.total());
    }

    const Kernel<D> kernel_{};
    std::array<double*, D> velocity_;
    double* volume_;
    Partners<D> partners_;
    sph::PairRecords<record_size> records_;
};

}  // namespace

void erosion_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
                  double time) {
    if (particles.dimension() == 1)
        sph::visit_cells(ErosionPass<1>(particles, table, which, settings, time), table, which);
    else
        sph::visit_cells(ErosionPass<2>(particles, table, which, settings, time), table, which);
}

void release_pass(ParticleSet& particles, const CellTable& table, Cells which) {
    if (particles.dimension() == 1)
        sph::visit_cells(ReleasePass<1>(particles, table, which), table, which);
    else
        sph::visit_cells(ReleasePass<2>(particles, table, which), table, which);
}

}  // namespace talus::depth
