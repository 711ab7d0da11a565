#include "physics/sph/pair_records.hpp"
#include "physics/sph/pass_support.hpp"
#include "physics/sph/passes.hpp"
#include "physics/sph/small_vectors.hpp"

namespace talus::sph {

namespace {

template <int D, class Kernel, bool strength>
class StandardPass {
  public:
    StandardPass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
                 const Kernel& kernel)
        : kernel_(kernel),
          alpha_(settings.viscosity_alpha),
          beta_(settings.viscosity_beta),
          acceleration_(components_to_write<D>(particles, field::acceleration)),
          power_(particles.data(field::specific_power)),
          viscous_speed_(particles.data(field::viscous_speed)),
          partners_(components<D>(particles, field::position), particles.data(field::smoothing_length),
                    kernel.support()),
          records_(particles, table, which) {
        records_.copy(place_position, components<D>(particles, field::position));
        records_.copy(place_velocity, components<D>(particles, field::predicted_velocity));
        records_.copy(place_mass, components<1>(particles, field::mass));
        records_.copy(place_density, components<1>(particles, field::predicted_density));
        records_.copy(place_sound_speed, components<1>(particles, field::sound_speed));
        records_.copy(place_h, components<1>(particles, field::smoothing_length));
        records_.copy(place_pressure, components<1>(particles, field::pressure));
        if constexpr (strength)
            records_.copy(place_stress, components<symmetric_count<D>>(particles, field::predicted_stress));
        records_.fill_copies(finish);
    }

    std::uint64_t visit(const CellEntry& cell, std::span<const Run> runs) {
        std::uint64_t pairs = 0;
        partners_.enter(cell, runs);
        records_.enter(runs, finish);
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            partners_.find_mutual(i, kernel_.support());
            evaluate(i);
            pairs += partners_.count();
        }
        return pairs;
    }

  private:
    static constexpr std::size_t place_position = 0, place_velocity = D, place_mass = 2 * D,
                                 place_density = place_mass + 1, place_sound_speed = place_mass + 2,
                                 place_h = place_mass + 3, place_inverse_h = place_mass + 4,
                                 place_pressure = place_mass + 5,  // this and the stress over density^2
        place_stress = place_mass + 6, record_size = place_stress + (strength ? symmetric_count<D> : 0);
    using Values = std::array<Lanes, record_size>;

    /// Sets what is not copied from a field.
    static constexpr auto finish = [](const Neighbours&, auto& values) {
        values[place_inverse_h] = 1 / values[place_h];
        const Lanes inverse_density2 = 1 / (values[place_density] * values[place_density]);
        for (std::size_t c = place_pressure; c < record_size; ++c) values[c] *= inverse_density2;
    };

    /// The traction of a particle's own stress along r, over its density squared.
    static Vector<Lanes, D> traction(const Values& values, const Lanes& pressure, const Vector<Lanes, D>& r) {
        Vector<Lanes, D> traction;
        for (std::size_t a = 0; a < D; ++a) {
            traction[a] = -pressure * r[a];
            if constexpr (strength) {
                Symmetric<Lanes, D> stress;
                for (std::size_t c = 0; c < stress.size(); ++c) stress[c] = values[place_stress + c];
                traction[a] += row_times(stress, a, r);
            }
        }
        return traction;
    }

    [[gnu::flatten]] void evaluate(std::uint32_t i) {
        const Values own = broadcast(records_[i]);
        const std::span<const std::uint32_t> partners = partners_.index();
        std::array<LaneSum, D> force{};
        LaneSum power;
        Lanes viscous_speed = 0;
        for (std::size_t k = 0; k < partners.size(); k += lane_count) {
            const Values other = records_.gather(partners.data() + k);
            Vector<Lanes, D> r, v_difference;
            for (std::size_t d = 0; d < D; ++d) {
                r[d] = own[place_position + d] - other[place_position + d];
                v_difference[d] = own[place_velocity + d] - other[place_velocity + d];
            }
            const Lanes r2 = dot(r, r);
            const Lanes factor =
                0.5 * (kernel_.factor(r2, own[place_inverse_h]) + kernel_.factor(r2, other[place_inverse_h]));
            const Lanes h = 0.5 * (own[place_h] + other[place_h]);
            const Lanes mu = min(h * dot(r, v_difference) / (r2 + 0.01 * h * h), Lanes(0.0));
            const Lanes c = 0.5 * (own[place_sound_speed] + other[place_sound_speed]);
            const Lanes viscosity =
                (beta_ * mu - alpha_ * c) * mu / (own[place_density] + other[place_density]);  // half of it
            viscous_speed = max(viscous_speed, select(mu < 0, alpha_ * c - 2 * beta_ * mu, Lanes(0.0)));
            // Each particle's own stress does the work of its own compression, which keeps cold gas next to
            // hot gas from cooling below zero; the viscosity heats both alike.
            const Lanes weight =
                select(first_lanes(partners.size() - k), other[place_mass] * factor, Lanes(0.0));
            const auto of_own = traction(own, own[place_pressure] + viscosity, r),
                       of_other = traction(other, other[place_pressure] + viscosity, r);
            Lanes work = 0;
            for (std::size_t a = 0; a < D; ++a) {
                force[a].add(k, weight * (of_own[a] + of_other[a]));
                work += of_own[a] * other[place_velocity + a] + of_other[a] * own[place_velocity + a];
            }
            power.add(k, weight * work);
        }
        for (std::size_t a = 0; a < D; ++a) acceleration_[a][i] = force[a].total();
        power_[i] = power.total();
        viscous_speed_[i] = hmax(viscous_speed);
    }

    const Kernel kernel_;
    const double alpha_, beta_;
    std::array<double*, D> acceleration_;
    double *power_, *viscous_speed_;
    Partners<D> partners_;
    PairRecords<record_size> records_;
};

}  // namespace

void standard_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
                   PassCount& count) {
    with_dimension(particles, [&](auto dimension) {
        constexpr int D = dimension;
        with_kernel<D>(settings, [&]<class Kernel>(const Kernel& kernel) {
            if (particles.has(field::predicted_stress))
                visit_cells(StandardPass<D, Kernel, true>(particles, table, which, settings, kernel), table,
                            which, count);
            else
                visit_cells(StandardPass<D, Kernel, false>(particles, table, which, settings, kernel), table,
                            which, count);
        });
    });
}

}  // namespace talus::sph
