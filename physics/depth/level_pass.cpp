#include "domain/depth_fields.hpp"
#include "physics/depth/corrected_gradient.hpp"
#include "physics/depth/kernel.hpp"
#include "physics/depth/passes.hpp"
#include "physics/sph/pair_records.hpp"
#include "physics/sph/pass_support.hpp"

namespace talus::depth {

namespace {

using sph::components;

template <int D>
class LevelPass {
  public:
    LevelPass(ParticleSet& particles, const CellTable& table, Cells which, double gravity)
        : gravity_(gravity),
          slope_(components<D>(particles, field::bed_slope)),
          acceleration_(sph::components_to_write<D>(particles, field::acceleration)),
          partners_(components<D>(particles, field::position), particles.data(field::smoothing_length),
                    Settings::support()),
          records_(particles, table, which) {
        partners_.search_by_blocks(particles.size() + (which == Cells::interior ? 0 : particles.halo_size()));
        records_.copy(0, components<D>(particles, field::position));
        records_.copy(place_volume, components<1>(particles, field::volume));
        records_.copy(place_inverse_s, components<1>(particles, field::smoothing_length));
        records_.copy(place_depth, components<1>(particles, field::depth));
        records_.copy(place_level, components<1>(particles, field::surface_level));
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
    static constexpr std::size_t place_volume = D, place_inverse_s = D + 1, place_depth = D + 2,
                                 place_level = D + 3, record_size = D + 4;
    static constexpr auto moment_count = static_cast<std::size_t>(sph::symmetric_count<D>);

    static constexpr auto finish = [](const sph::Neighbours&, auto& values) {
        values[place_inverse_s] = 1 / values[place_inverse_s];
    };

    [[gnu::flatten]] void evaluate(std::uint32_t i) {
        const auto own = sph::broadcast(records_[i]);
        const std::span<const std::uint32_t> partners = partners_.index();
        std::array<LaneSum, D> rise{};
        std::array<LaneSum, moment_count> moments{};
        for (std::size_t k = 0; k < partners.size(); k += lane_count) {
            const auto other = records_.gather(partners.data() + k);
            sph::Vector<Lanes, D> r;
            for (std::size_t d = 0; d < D; ++d) r[d] = own[d] - other[d];
            const Lanes area = other[place_volume] / other[place_depth];
            const Lanes weight =
                select(first_lanes(partners.size() - k),
                       area * kernel_.factor(sph::dot(r, r), own[place_inverse_s]), Lanes(0.0));
            const Lanes difference = weight * (other[place_level] - own[place_level]);
            for (std::size_t d = 0; d < D; ++d) rise[d].add(k, difference * r[d]);
            for (std::size_t a = 0; a < D; ++a)
                for (std::size_t b = a; b < D; ++b)
                    moments[static_cast<std::size_t>(
                                sph::symmetric_index<D>(static_cast<int>(a), static_cast<int>(b)))]
                        .add(k, -weight * r[a] * r[b]);
        }
        sph::Vector<double, D> sum, slope;
        sph::Symmetric<double, D> moment;
        for (std::size_t d = 0; d < D; ++d) {
            sum[d] = rise[d].total();
            slope[d] = slope_[d][i];
        }
        for (std::size_t c = 0; c < moment_count; ++c) moment[c] = moments[c].total();
        const CorrectedGradient<D> corrected(sum, moment, slope);
        for (std::size_t d = 0; d < D; ++d)
            acceleration_[d][i] -= gravity_ * (corrected.gradient[d] + corrected.lost[d]);
    }

    const Kernel<D> kernel_{};
    double gravity_;
    std::array<const double*, D> slope_;
    std::array<double*, D> acceleration_;
    Partners<D> partners_;
    sph::PairRecords<record_size> records_;
};

template <int D>
void run(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings) {
    sph::visit_cells(LevelPass<D>(particles, table, which, settings.gravity), table, which);
}

}  // namespace

void level_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings) {
    if (particles.dimension() == 1)
        run<1>(particles, table, which, settings);
    else
        run<2>(particles, table, which, settings);
}

}  // namespace talus::depth
