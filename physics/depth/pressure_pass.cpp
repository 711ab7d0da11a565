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

template <int D, bool of_phases>
class PressurePass {
  public:
    PressurePass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings)
        : settings_(settings),
          acceleration_(sph::components_to_write<D>(particles, field::acceleration)),
          signal_speed_(particles.data(field::signal_speed)),
          partners_(components<D>(particles, field::position), particles.data(field::smoothing_length),
                    Settings::support()),
          records_(particles, table, which) {
        partners_.search_by_blocks(particles.size() + (which == Cells::interior ? 0 : particles.halo_size()));
        records_.copy(place_position, components<D>(particles, field::position));
        records_.copy(place_velocity, components<D>(particles, field::predicted_velocity));
        records_.copy(place_volume, components<1>(particles, field::volume));
        records_.copy(place_inverse_s, components<1>(particles, field::smoothing_length));
        records_.copy(place_depth, components<1>(particles, field::depth));
        records_.copy(place_wave_speed, components<1>(particles, field::wave_speed));
        records_.copy(place_factor, components<1>(particles, field::pressure_factor));
        records_.copy(place_grad_h, components<1>(particles, field::grad_h_volume));
        if constexpr (of_phases) {
            records_.copy(place_phase, components<1>(particles, field::is_water));
            records_.copy(place_gravity, components<1>(particles, field::lateral_gravity));
            records_.copy(place_other_height, components<1>(particles, field::other_height));
            records_.copy(place_cover, components<1>(particles, field::other_cover));
        }
        records_.fill_copies(finish);
    }

    std::uint64_t visit(const CellEntry& cell, std::span<const Run> runs) {
        std::uint64_t pairs = 0;
        partners_.enter(cell, runs);
        records_.enter(runs, finish);
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            partners_.find_mutual(i, Settings::support());
            evaluate(i);
            pairs += partners_.count();
        }
        return pairs;
    }

  private:
    static constexpr std::size_t place_position = 0, place_velocity = D, place_volume = 2 * D,
                                 place_inverse_s = place_volume + 1, place_depth = place_volume + 2,
                                 place_wave_speed = place_volume + 3, place_factor = place_volume + 4,
                                 place_grad_h = place_volume + 5, place_phase = place_volume + 6,
                                 place_gravity = place_volume + 7, place_other_height = place_volume + 8,
                                 place_cover = place_volume + 9,
                                 record_size = place_volume + (of_phases ? 10 : 6);
    using Values = std::array<Lanes, record_size>;

    static constexpr auto finish = [](const sph::Neighbours&, auto& values) {
        values[place_inverse_s] = 1 / values[place_inverse_s];
    };

    [[gnu::flatten]] void evaluate(std::uint32_t i) {
        const Values own = sph::broadcast(records_[i]);
        const std::span<const std::uint32_t> partners = partners_.index();
        std::array<LaneSum, D> force{};
        Lanes fastest = own[place_wave_speed];
        [[maybe_unused]] const bool is_water = of_phases && records_[i].values[place_phase] != 0;
        for (std::size_t k = 0; k < partners.size(); k += lane_count) {
            const Values other = records_.gather(partners.data() + k);
            sph::Vector<Lanes, D> r, v_difference;
            for (std::size_t d = 0; d < D; ++d) {
                r[d] = own[place_position + d] - other[place_position + d];
                v_difference[d] = own[place_velocity + d] - other[place_velocity + d];
            }
            const Lanes r2 = sph::dot(r, r);
            const Lanes own_slope = kernel_.factor(r2, own[place_inverse_s]),
                        other_slope = kernel_.factor(r2, other[place_inverse_s]);
            const Lanes distance = sqrt(max(r2, Lanes(1e-300)));
            const Lanes closing = min(sph::dot(r, v_difference) / distance, Lanes(0.0));
            const Lanes mean_wave = 0.5 * (own[place_wave_speed] + other[place_wave_speed]);
            const Lanes viscosity = -settings_.viscosity * (mean_wave - 0.5 * closing) * closing /
                                    (own[place_depth] + other[place_depth]);
            // As if it came from the edge of the own kernel: what is further off acts over its own kernel.
            fastest =
                max(fastest, (mean_wave - closing) /
                                 max(distance * own[place_inverse_s] / Settings::support(), Lanes(1.0)));
            const Lanes volume = other[place_volume];
            const Lanes of_own = own[place_factor] * (volume - own[place_grad_h]) * own_slope,
                        of_other = other[place_factor] *
                                   (volume - other[place_grad_h] * volume / own[place_volume]) * other_slope;
            const Lanes mean_slope = 0.5 * (own_slope + other_slope);
            Lanes push = of_own + of_other + volume * mean_slope * viscosity;
            if constexpr (of_phases)
                push = select(own[place_phase] == other[place_phase], push,
                              of_other_phase(is_water, own, other, is_water ? other_slope : own_slope));
            push = select(first_lanes(partners.size() - k), push, Lanes(0.0));
            for (std::size_t d = 0; d < D; ++d) force[d].add(k, -push * r[d]);
        }
        for (std::size_t d = 0; d < D; ++d) acceleration_[d][i] = force[d].total();
        signal_speed_[i] = hmax(fastest);
    }

    /// The level of the water, as the solid finds it at its place, times the weight of that solid is an
    /// energy: the solid is pushed by its gradient, and the water by as much the other way. What the water's
    /// height has to do with how near its columns stand is in their pressure factor.
    Lanes of_other_phase(bool is_water, const Values& own, const Values& other,
                         const Lanes& solid_slope) const {
        const Values &solid = is_water ? other : own, &water = is_water ? own : other;
        const Lanes cover = solid[place_cover];
        const Lanes part_of_mean =
            select(cover < Lanes(full_cover), Lanes(0.0),
                   solid[place_other_height] * area_of<D>(1 / water[place_inverse_s], settings_.eta));
        const Lanes found = factor_ * water[place_gravity] * solid_slope *
                            (water[place_volume] - part_of_mean) / max(cover, Lanes(full_cover));
        return is_water ? found * solid[place_volume] / water[place_volume]
                        : settings_.two_phase->buoyancy() * found;
    }

    const Kernel<D> kernel_{};
    const Settings settings_;
    const double factor_ = lattice_factor<D>(settings_);
    std::array<double*, D> acceleration_;
    double* signal_speed_;
    Partners<D> partners_;
    sph::PairRecords<record_size> records_;
};

template <int D>
void run(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
         sph::PassCount& count) {
    if (settings.two_phase)
        sph::visit_cells(PressurePass<D, true>(particles, table, which, settings), table, which, count);
    else
        sph::visit_cells(PressurePass<D, false>(particles, table, which, settings), table, which, count);
}

}  // namespace

void pressure_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
                   sph::PassCount& count) {
    if (particles.dimension() == 1)
        run<1>(particles, table, which, settings, count);
    else
        run<2>(particles, table, which, settings, count);
}

}  // namespace talus::depth
