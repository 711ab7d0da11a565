#include <cmath>

#include "domain/water_fields.hpp"
#include "physics/sph/pass_support.hpp"
#include "physics/sph/small_vectors.hpp"
#include "physics/water/neighbourhood.hpp"
#include "physics/water/passes.hpp"

namespace talus::water {

namespace {

using sph::dot;
using sph::Vector;

template <int D>
class RatePass {
  public:
    RatePass(ParticleSet& particles, const Settings& settings)
        : rheology_(*settings.rheology),
          frame_(sph::components<D>(particles, field::position), settings.radius()),
          velocity_(sph::components<D>(particles, water_field::partner_velocity)),
          volume_(particles.data(water_field::partner_volume)),
          sticks_(particles.data(water_field::partner_density)),
          viscosity_(particles.data(water_field::viscosity)),
          partner_viscosity_(particles.data(water_field::partner_viscosity)),
          partner_gradient_(
              sph::components_to_write<std::size_t{D} * D>(particles, water_field::partner_gradient)) {
        const double radius = settings.radius(), c0 = settings.state.sound_speed,
                     rho0 = settings.state.reference_density;
        moment_scale_ = 5 * sph::WendlandC2<D>::norm * std::pow(Settings::support(), D + 2);
        rate_scale_ = c0 / radius;
        viscosity_scale_ = 1 / (rho0 * c0 * radius);
    }

    void visit(const CellEntry& cell, std::span<const Run> runs) {
        const auto is_water = [](float volume) { return volume > 0; };
        if (std::none_of(volume_ + cell.begin, volume_ + cell.end, is_water)) return;
        gather(cell, runs);
        for (std::uint32_t i = cell.begin; i < cell.end; ++i)
            if (is_water(volume_[i])) evaluate(i);
    }

  private:
    static constexpr std::size_t at_velocity = D, at_volume = 2 * D, value_count = 2 * D + 1;
    static constexpr int pair_count = sph::symmetric_count<D>;

    /// Water, and of walls those that do not slip.
    void gather(const CellEntry& cell, std::span<const Run> runs) {
        frame_.enter(cell);
        partners_.clear(count_of(runs));
        const auto all = [](std::uint32_t, std::size_t) { return ~LaneBits{0}; };
        frame_.for_each_near(
            runs, all,
            [this](std::uint32_t k, std::size_t number, const std::array<FloatLanes, D>& x, LaneBits bits) {
                std::array<FloatLanes, value_count> values;
                for (int d = 0; d < D; ++d) {
                    values[at_velocity + d] = load_first(velocity_[d] + k, number);
                    values[d] = x[d];
                }
                const FloatLanes volume = load_first(volume_ + k, number), zero = 0.0F;
                values[at_volume] = max(volume, zero) + max(-volume, zero) * load_first(sticks_ + k, number);
                partners_.append(bits, values);
            });
        partners_.pad();
    }

    [[gnu::flatten]] void evaluate(std::uint32_t i) {
        std::array<FloatLaneSum, D * D> moments_of_velocity{};
        std::array<FloatLaneSum, pair_count> moments{};
        const std::array<const float*, value_count> from = partners_.columns();
        for (std::size_t k = 0; k < partners_.size(); k += float_lane_count) {
            Vector<FloatLanes, D> r, v;
            for (int d = 0; d < D; ++d) {
                r[d] = frame_.place(d, i) - load(from[d] + k);
                v[d] = velocity_[d][i] - load(from[at_velocity + d] + k);
            }
            const FloatLanes x = max(1 - sqrt(dot(r, r)), FloatLanes(0.0F)),
                             weight = load(from[at_volume] + k) * (x * x * x);
            for (int a = 0; a < D; ++a)
                for (int b = 0; b < D; ++b) {
                    moments_of_velocity[D * a + b].add(k, weight * v[a] * r[b]);
                    if (a <= b) moments[sph::symmetric_index<D>(a, b)].add(k, weight * r[a] * r[b]);
                }
        }
        std::array<double, pair_count> matrix;
        for (int c = 0; c < pair_count; ++c) matrix[c] = moment_scale_ * moments[c].total();
        const std::array<double, pair_count> inverse = sph::inverse_or_identity<D>(matrix);
        std::array<double, D * D> gradient{};  // dv_a/dx_b, over c0/R
        for (int a = 0; a < D; ++a)
            for (int c = 0; c < D; ++c) {
                const double moment = moment_scale_ * moments_of_velocity[D * a + c].total();
                for (int b = 0; b < D; ++b)
                    gradient[D * a + b] +=
                        moment * inverse[sph::symmetric_index<D>(std::min(b, c), std::max(b, c))];
            }
        double twice_squared = 0;  // 2 D : D
        for (int a = 0; a < D; ++a)
            for (int b = 0; b < D; ++b) {
                const double strain = gradient[D * a + b] + gradient[D * b + a];
                twice_squared += 0.5 * strain * strain;
            }
        for (int c = 0; c < D * D; ++c) partner_gradient_[c][i] = static_cast<float>(gradient[c]);
        viscosity_[i] = rheology_.viscosity(rate_scale_ * std::sqrt(twice_squared));
        partner_viscosity_[i] = static_cast<float>(viscosity_scale_ * viscosity_[i]);
    }

    const Rheology rheology_;
    LocalFrame<D> frame_;
    std::array<const float*, D> velocity_;
    const float *volume_, *sticks_;
    double* viscosity_;
    float* partner_viscosity_;
    std::array<float*, std::size_t{D} * D> partner_gradient_;
    double moment_scale_, rate_scale_, viscosity_scale_;
    Block<value_count> partners_;
};

}  // namespace

void rate_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings) {
    const auto run = [&](auto&& pass) {
        table.for_each_own(which, [&pass](const CellEntry& cell, std::span<const Run> runs, std::size_t) {
            pass.visit(cell, runs);
        });
    };
    if (particles.dimension() == 2)
        run(RatePass<2>(particles, settings));
    else
        run(RatePass<3>(particles, settings));
}

}  // namespace talus::water
