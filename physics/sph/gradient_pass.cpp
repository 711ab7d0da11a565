#include "physics/sph/pair_records.hpp"
#include "physics/sph/pass_support.hpp"
#include "physics/sph/passes.hpp"
#include "physics/sph/small_vectors.hpp"

namespace talus::sph {

namespace {

/// Sums over the partners of one particle, V_j = m_j / ((rho_i + rho_j) / 2): weighed by the partner's volume
/// alone, the continuity equation overcompresses in shocks, by 1 % at a compression of 1.8; by its mass, it
/// undercompresses as much.
template <class Sum, int D>
struct GradientSums {
    Vector<Sum, D> raw{};                            ///< sum m grad W
    Vector<Sum, D> pressure{};                       ///< sum V_j (P_j - P_i) grad W
    std::array<Sum, std::size_t{D} * D> velocity{};  ///< sum V_j (v_j - v_i) grad W
    Symmetric<Sum, D> moment{};                      ///< sum V_j (x_j - x_i) grad W
};

template <std::size_t count>
std::array<double, count> totals(const std::array<LaneSum, count>& sums) {
    std::array<double, count> values;
    for (std::size_t c = 0; c < count; ++c) values[c] = sums[c].total();
    return values;
}

template <int D, class Kernel, bool with_pressure>
class GradientPass {
  public:
    GradientPass(ParticleSet& particles, const CellTable& table, Cells which, const Kernel& kernel)
        : kernel_(kernel),
          density_(particles.data(field::predicted_density)),
          smoothing_length_(particles.data(field::smoothing_length)),
          velocity_gradient_(components_to_write<D * D>(particles, field::velocity_gradient)),
          partners_(components<D>(particles, field::position), smoothing_length_, kernel.support()),
          records_(particles, table, which) {
        if constexpr (with_pressure) {
            pressure_gradient_ = components_to_write<D>(particles, field::pressure_gradient);
            volume_gradient_ = components_to_write<D>(particles, field::volume_gradient);
            records_.copy(place_pressure, components<1>(particles, field::pressure));
        }
        records_.copy(place_position, components<D>(particles, field::position));
        records_.copy(place_velocity, components<D>(particles, field::predicted_velocity));
        records_.copy(place_mass, components<1>(particles, field::mass));
        records_.copy(place_density, components<1>(particles, field::predicted_density));
        records_.fill_copies(finish());
    }

    void visit(const CellEntry& cell, std::span<const Run> runs) {
        partners_.enter(cell, runs);
        records_.enter(runs, finish());
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            partners_.find(i, kernel_.support());
            store(i, sum_over_partners(i));
        }
    }

  private:
    static constexpr std::size_t place_position = 0, place_velocity = D, place_mass = 2 * D,
                                 place_density = place_mass + 1, place_pressure = place_mass + 2,
                                 record_size = place_pressure + (with_pressure ? 1 : 0);

    /// Sets what is not copied from a field.
    auto finish() const {
        return [](const Neighbours&, auto&) {};
    }

    [[gnu::flatten]] GradientSums<double, D> sum_over_partners(std::uint32_t i) const {
        const auto own = broadcast(records_[i]);
        const Lanes inverse_h = 1 / smoothing_length_[i];
        const std::span<const std::uint32_t> partners = partners_.index();
        GradientSums<LaneSum, D> sums;
        for (std::size_t k = 0; k < partners.size(); k += lane_count) {
            const auto other = records_.gather(partners.data() + k);
            Vector<Lanes, D> r;  // x_i - x_j
            for (std::size_t d = 0; d < D; ++d) r[d] = own[place_position + d] - other[place_position + d];
            const Lanes factor =
                select(first_lanes(partners.size() - k), kernel_.factor(dot(r, r), inverse_h), Lanes(0.0));
            const Lanes mean_density = 0.5 * (own[place_density] + other[place_density]);
            const Lanes volume_factor = other[place_mass] * factor / mean_density;
            Vector<Lanes, D> volume_gradient;
            for (std::size_t b = 0; b < D; ++b) volume_gradient[b] = volume_factor * r[b];
            for (std::size_t b = 0; b < D; ++b) {
                if constexpr (with_pressure) {
                    sums.raw[b].add(k, other[place_mass] * factor * r[b]);
                    sums.pressure[b].add(k,
                                         (other[place_pressure] - own[place_pressure]) * volume_gradient[b]);
                }
                for (std::size_t a = 0; a < D; ++a) {
                    sums.velocity[a * D + b].add(
                        k, (other[place_velocity + a] - own[place_velocity + a]) * volume_gradient[b]);
                    if (a <= b) sums.moment[moment_index(a, b)].add(k, -r[a] * volume_gradient[b]);
                }
            }
        }
        return {totals(sums.raw), totals(sums.pressure), totals(sums.velocity), totals(sums.moment)};
    }
    static constexpr std::size_t moment_index(std::size_t a, std::size_t b) {
        return static_cast<std::size_t>(symmetric_index<D>(static_cast<int>(a), static_cast<int>(b)));
    }

    void store(std::uint32_t i, const GradientSums<double, D>& sums) {
        const auto correction = inverse_or_identity<D>(sums.moment);
        const auto corrected = [&](const double* raw, int b) {
            double total = 0;
            for (int c = 0; c < D; ++c)
                total += raw[c] * correction[symmetric_index<D>(c < b ? c : b, c < b ? b : c)];
            return total;
        };
        for (int a = 0; a < D; ++a)
            for (int b = 0; b < D; ++b)
                velocity_gradient_[a * D + b][i] = corrected(&sums.velocity[a * D], b);
        if constexpr (with_pressure) {
            const double inverse_density2 = 1 / (density_[i] * density_[i]);
            for (int b = 0; b < D; ++b) {
                pressure_gradient_[b][i] = corrected(sums.pressure.data(), b);
                volume_gradient_[b][i] = -sums.raw[b] * inverse_density2;
            }
        }
    }

    const Kernel kernel_;
    const double *density_, *smoothing_length_;
    std::array<double*, D * D> velocity_gradient_;
    std::array<double*, D> pressure_gradient_{}, volume_gradient_{};
    Partners<D> partners_;
    PairRecords<record_size> records_;
};

template <int D, class Kernel, bool with_pressure>
void run(ParticleSet& particles, const CellTable& table, Cells which, const Kernel& kernel) {
    GradientPass<D, Kernel, with_pressure> pass(particles, table, which, kernel);
    table.for_each_own(which, [&pass](const CellEntry& cell, std::span<const Run> runs, std::size_t) {
        pass.visit(cell, runs);
    });
}

}  // namespace

void gradient_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings) {
    with_dimension(particles, [&](auto dimension) {
        constexpr int D = dimension;
        if (particles.has(field::pressure_gradient))  // Godunov SPH, always with the Gaussian
            run<D, Gaussian<D>, true>(particles, table, which, Gaussian<D>(settings.cutoff));
        else
            with_kernel<D>(settings, [&]<class Kernel>(const Kernel& kernel) {
                run<D, Kernel, false>(particles, table, which, kernel);
            });
    });
}

}  // namespace talus::sph
