#include "physics/sph/pass_support.hpp"
#include "physics/sph/passes.hpp"
#include "physics/sph/small_tensors.hpp"

namespace talus::sph {

namespace {

/// Sums over the partners of one particle, V_j = m_j / ((rho_i + rho_j) / 2): weighed by the partner's volume
/// alone, the continuity equation overcompresses in shocks, by 1 % at a compression of 1.8; by its mass, it
/// undercompresses as much.
template <int D>
struct GradientSums {
    std::array<double, D> raw{};                      ///< sum m grad W
    std::array<double, D> pressure{};                 ///< sum V_j (P_j - P_i) grad W
    std::array<double, D * D> velocity{};             ///< sum V_j (v_j - v_i) grad W
    std::array<double, symmetric_count<D>> moment{};  ///< sum V_j (x_j - x_i) grad W
};

template <int D, class Kernel, bool with_pressure>
class GradientPass {
  public:
    GradientPass(ParticleSet& particles, const Kernel& kernel)
        : particles_(particles),
          kernel_(kernel),
          position_(components<D>(particles, field::position)),
          velocity_(components<D>(particles, field::predicted_velocity)),
          mass_(particles.data(field::mass)),
          density_(particles.data(field::predicted_density)),
          pressure_(with_pressure ? particles.data(field::pressure) : nullptr),
          smoothing_length_(particles.data(field::smoothing_length)),
          velocity_gradient_(components_to_write<D * D>(particles, field::velocity_gradient)) {
        if constexpr (with_pressure) {
            pressure_gradient_ = components_to_write<D>(particles, field::pressure_gradient);
            volume_gradient_ = components_to_write<D>(particles, field::volume_gradient);
        }
    }

    void visit(const CellEntry& cell, std::span<const Run> runs) {
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            const double range = kernel_.support() * smoothing_length_[i], range2 = range * range;
            partners_.find(position_, i, runs, [range2](std::uint32_t) { return range2; });
            x_.gather(partners_, position_);
            v_.gather(partners_, velocity_);
            partners_.gather(mass_, m_);
            partners_.gather(density_, rho_);
            if constexpr (with_pressure) partners_.gather(pressure_, p_);
            store(i, sum(i));
        }
    }

  private:
    GradientSums<D> sum(std::uint32_t i) {
        const std::size_t n = partners_.count();
        const double inverse_h = 1 / smoothing_length_[i];
        const auto x_j = x_.data(), v_j = v_.data();
        const double *m_j = m_.data(), *rho_j = rho_.data(), *p_j = p_.data();
        std::array<double, D> x_i, v_i;
        for (int d = 0; d < D; ++d) {
            x_i[d] = position_[d][i];
            v_i[d] = velocity_[d][i];
        }
        const double p_i = with_pressure ? pressure_[i] : 0, rho_i = density_[i];

        weight_.reserve(n);
        volume_weight_.reserve(n);
        double *weight = weight_.data(), *volume_weight = volume_weight_.data();
#pragma omp simd
        for (std::size_t k = 0; k < n; ++k) {
            double r2 = 0;
            for (int d = 0; d < D; ++d) r2 += (x_i[d] - x_j[d][k]) * (x_i[d] - x_j[d][k]);
            weight[k] = m_j[k] * kernel_.factor(r2, inverse_h);
            volume_weight[k] = weight[k] / (0.5 * (rho_i + rho_j[k]));
        }
        GradientSums<D> sums;
        const auto dot = [n](auto&& term) {
            double total = 0;
#pragma omp simd reduction(+ : total)
            for (std::size_t k = 0; k < n; ++k) total += term(k);
            return total;
        };
        for (int b = 0; b < D; ++b) {
            const double x_ib = x_i[b];
            const double* x_jb = x_j[b];
            if constexpr (with_pressure) {
                sums.raw[b] = dot([=](std::size_t k) { return weight[k] * (x_ib - x_jb[k]); });
                sums.pressure[b] =
                    dot([=](std::size_t k) { return volume_weight[k] * (p_j[k] - p_i) * (x_ib - x_jb[k]); });
            }
            for (int a = 0; a < D; ++a) {
                const double v_ia = v_i[a], x_ia = x_i[a];
                const double *v_ja = v_j[a], *x_ja = x_j[a];
                sums.velocity[a * D + b] = dot(
                    [=](std::size_t k) { return volume_weight[k] * (v_ja[k] - v_ia) * (x_ib - x_jb[k]); });
                if (a > b) continue;
                sums.moment[symmetric_index<D>(a, b)] = dot(
                    [=](std::size_t k) { return volume_weight[k] * (x_ja[k] - x_ia) * (x_ib - x_jb[k]); });
            }
        }
        return sums;
    }

    void store(std::uint32_t i, const GradientSums<D>& sums) {
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

    ParticleSet& particles_;
    const Kernel kernel_;
    std::array<const double*, D> position_, velocity_;
    const double *mass_, *density_, *pressure_, *smoothing_length_;
    std::array<double*, D * D> velocity_gradient_;
    std::array<double*, D> pressure_gradient_{}, volume_gradient_{};
    Partners<D> partners_;
    PartnerValues<D> x_, v_;
    AlignedValues m_, rho_, p_, weight_, volume_weight_;
};

template <int D, class Kernel, bool with_pressure>
void run(ParticleSet& particles, const CellTable& table, Cells which, const Kernel& kernel) {
    GradientPass<D, Kernel, with_pressure> pass(particles, kernel);
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
