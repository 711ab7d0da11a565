#include "physics/sph/pass_support.hpp"
#include "physics/sph/passes.hpp"
#include "physics/sph/small_tensors.hpp"

namespace talus::sph {

namespace {

template <int D, class Kernel, bool strength>
class StandardPass {
  public:
    StandardPass(ParticleSet& particles, const Settings& settings, const Kernel& kernel)
        : kernel_(kernel),
          settings_(settings),
          position_(components<D>(particles, field::position)),
          velocity_(components<D>(particles, field::predicted_velocity)),
          acceleration_(components_to_write<D>(particles, field::acceleration)),
          power_(particles.data(field::specific_power)),
          viscous_speed_(particles.data(field::viscous_speed)),
          partners_(position_, particles.data(field::smoothing_length), kernel.support()) {
        scalars_ = {particles.data(field::mass), particles.data(field::predicted_density),
                    particles.data(field::pressure), particles.data(field::sound_speed),
                    particles.data(field::smoothing_length)};
        if constexpr (strength) stress_ = components<symmetric_count<D>>(particles, field::predicted_stress);
    }

    std::uint64_t visit(const CellEntry& cell, std::span<const Run> runs) {
        std::uint64_t pairs = 0;
        partners_.enter(cell, runs);
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            partners_.find_mutual(i, kernel_.support());
            x_.gather(partners_, position_);
            v_.gather(partners_, velocity_);
            values_.gather(partners_, scalars_);
            if constexpr (strength) stresses_.gather(partners_, stress_);
            evaluate(i);
            pairs += partners_.count();
        }
        return pairs;
    }

  private:
    enum Scalar { mass, density, pressure, sound_speed, smoothing_length, scalar_count };

    void evaluate(std::uint32_t i) {
        const std::size_t n = partners_.count();
        const auto x = x_.data(), v = v_.data();
        const auto values = values_.data();
        const auto s = stresses_.data();
        const Kernel kernel = kernel_;
        const double alpha = settings_.viscosity_alpha, beta = settings_.viscosity_beta;
        const double support2 = kernel.support() * kernel.support();
        std::array<double, D> x_i, v_i;
        for (int d = 0; d < D; ++d) {
            x_i[d] = position_[d][i];
            v_i[d] = velocity_[d][i];
        }
        const double rho_i = scalars_[density][i], c_i = scalars_[sound_speed][i],
                     h_i = scalars_[smoothing_length][i];
        const double inverse_rho2_i = 1 / (rho_i * rho_i), p_i = scalars_[pressure][i] * inverse_rho2_i;
        std::array<double, symmetric_count<D>> s_i{};
        if constexpr (strength)
            for (int c = 0; c < symmetric_count<D>; ++c) s_i[c] = stress_[c][i] * inverse_rho2_i;
        std::array<double*, D + 1> terms;
        double viscous_speed = 0;
        for (int d = 0; d <= D; ++d) {
            terms_[d].reserve(n);
            terms[d] = terms_[d].data();
        }
#pragma omp simd reduction(max : viscous_speed)
        for (std::size_t k = 0; k < n; ++k) {
            std::array<double, D> r;
            double r2 = 0, approach = 0;
            for (int d = 0; d < D; ++d) {
                r[d] = x_i[d] - x[d][k];
                r2 += r[d] * r[d];
                approach += r[d] * (v_i[d] - v[d][k]);
            }
            const double rho_j = values[density][k], h_j = values[smoothing_length][k];
            const double inverse_rho2_j = 1 / (rho_j * rho_j);
            // Mean of both kernels' gradients, each within its own support.
            const double near_i = r2 < support2 * h_i * h_i ? 0.5 : 0.0,
                         near_j = r2 < support2 * h_j * h_j ? 0.5 : 0.0;
            const double factor = near_i * kernel.factor(r2, 1 / h_i) + near_j * kernel.factor(r2, 1 / h_j);
            const double h = 0.5 * (h_i + h_j);
            const double mu = std::min(h * approach / (r2 + 0.01 * h * h), 0.0);
            const double c = 0.5 * (c_i + values[sound_speed][k]);
            const double viscosity = (beta * mu - alpha * c) * mu / (0.5 * (rho_i + rho_j));
            viscous_speed = std::max(viscous_speed, mu < 0 ? alpha * c - 2 * beta * mu : 0.0);
            // Each particle's own stress does the work of its own compression, which keeps cold gas next to
            // hot gas from cooling below zero; the viscosity heats both alike.
            const double p_j = values[pressure][k] * inverse_rho2_j;
            const double weight = values[mass][k] * factor;
            double power = 0;
            for (int a = 0; a < D; ++a) {
                double own = -(p_i + 0.5 * viscosity) * r[a], other = -(p_j + 0.5 * viscosity) * r[a];
                if constexpr (strength)
                    for (int b = 0; b < D; ++b) {
                        const int c_ab = symmetric_index<D>(a < b ? a : b, a < b ? b : a);
                        own += s_i[c_ab] * r[b];
                        other += s[c_ab][k] * inverse_rho2_j * r[b];
                    }
                terms[a][k] = weight * (own + other);
                power += weight * (own * v[a][k] + other * v_i[a]);
            }
            terms[D][k] = power;
        }
        for (int d = 0; d <= D; ++d) {
            double total = 0;
            const double* term = terms[d];
#pragma omp simd reduction(+ : total)
            for (std::size_t k = 0; k < n; ++k) total += term[k];
            (d < D ? acceleration_[d < D ? d : 0] : power_)[i] = total;
        }
        viscous_speed_[i] = viscous_speed;
    }

    const Kernel kernel_;
    const Settings settings_;
    std::array<const double*, D> position_, velocity_;
    std::array<const double*, scalar_count> scalars_;
    std::array<const double*, symmetric_count<D>> stress_{};
    std::array<double*, D> acceleration_;
    double *power_, *viscous_speed_;
    Partners<D> partners_;
    PartnerValues<D> x_, v_;
    PartnerValues<scalar_count> values_;
    PartnerValues<symmetric_count<D>> stresses_;
    std::array<AlignedValues, D + 1> terms_;
};

template <class Pass>
void run(Pass&& pass, const CellTable& table, Cells which, PassCount& count) {
    table.for_each_own(which, [&](const CellEntry& cell, std::span<const Run> runs, std::size_t k) {
        const std::uint64_t pairs = pass.visit(cell, runs);
        count.pairs += pairs;
        count.work_of_cell[k] = static_cast<double>(pairs);
    });
}

}  // namespace

void standard_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
                   PassCount& count) {
    with_dimension(particles, [&](auto dimension) {
        constexpr int D = dimension;
        with_kernel<D>(settings, [&]<class Kernel>(const Kernel& kernel) {
            if (particles.has(field::predicted_stress))
                run(StandardPass<D, Kernel, true>(particles, settings, kernel), table, which, count);
            else
                run(StandardPass<D, Kernel, false>(particles, settings, kernel), table, which, count);
        });
    });
}

}  // namespace talus::sph
