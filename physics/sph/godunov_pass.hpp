#pragma once
#include "physics/sph/godunov_pair.hpp"
#include "physics/sph/pair_records.hpp"
#include "physics/sph/pass_support.hpp"
#include "physics/sph/passes.hpp"

namespace talus::sph {

/// Makes the records of the pair loop from the fields of all particles.
template <int D, class Options>
PairRecords<GodunovPlaces<D, Options>::count> godunov_records(const ParticleSet& particles,
                                                              bool several_bodies) {
    using Places = GodunovPlaces<D, Options>;
    PairRecords<Places::count> records(particles.size_with_halo());
    records.copy(Places::position, components<D>(particles, field::position));
    records.copy(Places::velocity, components<D>(particles, field::predicted_velocity));
    records.copy(Places::volume_gradient, components<D>(particles, field::volume_gradient));
    records.copy(Places::pressure_gradient, components<D>(particles, field::pressure_gradient));
    records.copy(Places::mass, components<1>(particles, field::mass));
    records.copy(Places::density, components<1>(particles, field::predicted_density));
    records.copy(Places::pressure, components<1>(particles, field::pressure));
    records.copy(Places::sound_speed, components<1>(particles, field::sound_speed));
    if constexpr (Options::strength)
        records.copy(Places::stress, components<symmetric_count<D>>(particles, field::predicted_stress));
    if constexpr (Options::quintic)
        records.copy(Places::curvature, components<symmetric_count<D>>(particles, field::volume_curvature));
    if constexpr (Options::variable_h)
        records.copy(Places::h, components<1>(particles, field::smoothing_length));
    const auto gradient = components<D * D>(particles, field::velocity_gradient);
    const std::uint8_t* body = particles.data(field::body);
    records.fill([=](std::size_t k, auto& values) {
        for (int a = 0; a < D; ++a)
            for (int b = a; b < D; ++b)
                values[Places::strain_rate + symmetric_index<D>(a, b)] =
                    0.5 * (gradient[a * D + b][k] + gradient[b * D + a][k]);
        values[Places::specific_volume] = 1 / values[Places::density];
        if constexpr (Options::bodies) values[Places::body] = several_bodies ? body[k] : 0;
    });
    return records;
}

template <int D, class Options>
class GodunovPass {
  public:
    GodunovPass(ParticleSet& particles, const Settings& settings, double time_step)
        : kernel_(settings.cutoff),
          settings_(settings),
          time_step_(time_step),
          smoothing_length_(particles.data(field::smoothing_length)),
          acceleration_(components_to_write<D>(particles, field::acceleration)),
          power_(particles.data(field::specific_power)),
          partners_(components<D>(particles, field::position), smoothing_length_, settings.force_support()),
          records_(godunov_records<D, Options>(particles, settings.several_bodies)) {}

    /// Work done on all particles of a cell; returns the number of pairs.
    std::uint64_t visit(const CellEntry& cell, std::span<const Run> runs) {
        std::uint64_t pairs = 0;
        partners_.enter(cell, runs);
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

    [[gnu::flatten]] void evaluate(std::uint32_t i) {
        const Particle own{broadcast(records_[i])};
        const Lanes h = smoothing_length_[i];
        const std::span<const std::uint32_t> partners = partners_.index();
        GodunovForce<Lanes, D> total{};
        for (std::size_t k = 0; k < partners.size(); k += lane_count) {
            const Particle other{records_.gather(partners.data() + k)};
            const auto term = godunov_pair<D, Options>(own, other, h, kernel_, settings_, time_step_);
            const Lanes mass =
                select(first_lanes(partners.size() - k), other.scalar(Places::mass), Lanes(0.0));
            for (std::size_t d = 0; d < D; ++d) total.force[d] += mass * term.force[d];
            total.power += mass * term.power;
        }
        for (std::size_t d = 0; d < D; ++d) acceleration_[d][i] = sum(total.force[d]);
        power_[i] = sum(total.power);
    }

    const Gaussian<D> kernel_;
    const Settings settings_;
    const double time_step_;
    const double* smoothing_length_;
    std::array<double*, D> acceleration_;
    double* power_;
    Partners<D> partners_;
    PairRecords<Places::count> records_;
};

/// Runs the pass with the options that fit the fields of the set and the settings.
template <int D>
void run_godunov(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
                 double time_step, PassCount& count);

extern template void run_godunov<1>(ParticleSet&, const CellTable&, Cells, const Settings&, double,
                                    PassCount&);
extern template void run_godunov<2>(ParticleSet&, const CellTable&, Cells, const Settings&, double,
                                    PassCount&);
extern template void run_godunov<3>(ParticleSet&, const CellTable&, Cells, const Settings&, double,
                                    PassCount&);

}  // namespace talus::sph
