#pragma once
#include "physics/sph/godunov_pair.hpp"
#include "physics/sph/pair_records.hpp"
#include "physics/sph/pass_support.hpp"
#include "physics/sph/passes.hpp"

namespace talus::sph {

template <int D, class Options>
class GodunovPass {
  public:
    GodunovPass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings)
        : kernel_(settings.cutoff),
          settings_(settings),
          smoothing_length_(particles.data(field::smoothing_length)),
          acceleration_(components_to_write<D>(particles, field::acceleration)),
          power_(particles.data(field::specific_power)),
          partners_(components<D>(particles, field::position), smoothing_length_, settings.force_support()),
          velocity_gradient_(components<D * D>(particles, field::velocity_gradient)),
          body_(settings.several_bodies ? particles.data(field::body) : nullptr),
          records_(particles, table, which) {
        records_.copy(Places::position, components<D>(particles, field::position));
        records_.copy(Places::velocity, components<D>(particles, field::predicted_velocity));
        records_.copy(Places::volume_gradient, components<D>(particles, field::volume_gradient));
        records_.copy(Places::pressure_gradient, components<D>(particles, field::pressure_gradient));
        records_.copy(Places::mass, components<1>(particles, field::mass));
        records_.copy(Places::density, components<1>(particles, field::predicted_density));
        records_.copy(Places::pressure, components<1>(particles, field::pressure));
        records_.copy(Places::sound_speed, components<1>(particles, field::sound_speed));
        if constexpr (Options::strength)
            records_.copy(Places::stress, components<symmetric_count<D>>(particles, field::predicted_stress));
        if constexpr (Options::quintic)
            records_.copy(Places::curvature,
                          components<symmetric_count<D>>(particles, field::volume_curvature));
        if constexpr (Options::variable_h)
            records_.copy(Places::h, components<1>(particles, field::smoothing_length));
        records_.fill_copies(finish());
    }

    /// Work done on all particles of a cell; returns the number of pairs.
    std::uint64_t visit(const CellEntry& cell, std::span<const Run> runs) {
        std::uint64_t pairs = 0;
        partners_.enter(cell, runs);
        records_.enter(runs, finish());
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            if constexpr (Options::variable_h)
                partners_.find_mutual(i, settings_.force_support());
            else
                partners_.find(i, settings_.force_support());
            evaluate(i);
            pairs += partners_.count();
        }
        return pairs;
    }

  private:
    using Places = GodunovPlaces<D, Options>;
    using Particle = GodunovParticle<Lanes, D, Options>;

    /// Sets what is not copied from a field.
    auto finish() const {
        return [gradient = velocity_gradient_, bodies = body_](const Neighbours& some, auto& values) {
            for (int a = 0; a < D; ++a)
                for (int b = a; b < D; ++b)
                    values[Places::strain_rate + symmetric_index<D>(a, b)] =
                        0.5 * (some.of(gradient[a * D + b]) + some.of(gradient[b * D + a]));
            values[Places::specific_volume] = 1 / values[Places::density];
            if constexpr (Options::bodies)
                values[Places::body] = Lanes([&](std::size_t lane) -> double {
                    return bodies && lane < some.number ? bodies[some.first + lane] : 0;
                });
        };
    }

    [[gnu::flatten]] void evaluate(std::uint32_t i) {
        const Particle own{broadcast(records_[i])};
        const Lanes h = smoothing_length_[i];
        const std::span<const std::uint32_t> partners = partners_.index();
        std::array<LaneSum, D> force{};
        LaneSum power;
        for (std::size_t k = 0; k < partners.size(); k += lane_count) {
            const Particle other{records_.gather(partners.data() + k)};
            const auto term = godunov_pair<D, Options>(own, other, h, kernel_, settings_);
            const Lanes mass =
                select(first_lanes(partners.size() - k), other.scalar(Places::mass), Lanes(0.0));
            for (std::size_t d = 0; d < D; ++d) force[d].add(k, mass * term.force[d]);
            power.add(k, mass * term.power);
        }
        for (std::size_t d = 0; d < D; ++d) acceleration_[d][i] = force[d].total();
        power_[i] = power.total();
    }

    const Gaussian<D> kernel_;
    const Settings settings_;
    const double* smoothing_length_;
    std::array<double*, D> acceleration_;
    double* power_;
    Partners<D> partners_;
    std::array<const double*, D * D> velocity_gradient_;
    const std::uint8_t* body_;  ///< null: all the same
    PairRecords<Places::count> records_;
};

/// Runs the pass with the options that fit the fields of the set and the settings.
template <int D>
void run_godunov(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
                 PassCount& count);

extern template void run_godunov<1>(ParticleSet&, const CellTable&, Cells, const Settings&, PassCount&);
extern template void run_godunov<2>(ParticleSet&, const CellTable&, Cells, const Settings&, PassCount&);
extern template void run_godunov<3>(ParticleSet&, const CellTable&, Cells, const Settings&, PassCount&);

}  // namespace talus::sph
