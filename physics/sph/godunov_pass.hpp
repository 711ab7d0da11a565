#pragma once
#include "physics/sph/pair_terms.hpp"
#include "physics/sph/pass_support.hpp"
#include "physics/sph/passes.hpp"
#include "physics/sph/small_tensors.hpp"

namespace talus::sph {

/// What varies inside the pair loop of Godunov SPH; each combination is compiled on its own.
template <bool strength_, bool variable_h_, bool quintic_, bool bodies_>
struct GodunovOptions {
    static constexpr bool strength = strength_;      ///< deviatoric stress
    static constexpr bool variable_h = variable_h_;  ///< both particles' smoothing lengths
    static constexpr bool quintic = quintic_;        ///< the quintic may be chosen
    static constexpr bool bodies = bodies_;          ///< several bodies: no tension or shear across contacts
};

/// One particle's values in the pair loop.
template <int D>
struct GodunovParticle {
    std::array<double, D> x, v, volume_gradient, pressure_gradient;
    std::array<double, D * D> velocity_gradient;
    std::array<double, symmetric_count<D>> stress, curvature;
    double mass, density, pressure, sound_speed, h, body;
};

/// Force per mass of both and work per mass of both and time that j exerts on i.
template <int D>
struct GodunovForce {
    std::array<double, D> force;  ///< [m/s2 per kg of j]
    double power;                 ///< [W/kg per kg of j]
};

template <int D>
double along(const std::array<double, D>& vector, const std::array<double, D>& e) {
    double sum = 0;
    for (int d = 0; d < D; ++d) sum += vector[d] * e[d];
    return sum;
}

/// Slope of the velocity component along e in the direction e.
template <int D>
double stretch(const std::array<double, D * D>& gradient, const std::array<double, D>& e) {
    double sum = 0;
    for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) sum += e[a] * gradient[a * D + b] * e[b];
    return sum;
}

/// The symmetric tensor's second component along e.
template <int D>
double normal_component(const std::array<double, symmetric_count<D>>& tensor,
                        const std::array<double, D>& e) {
    double sum = 0;
    for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b)
            sum += e[a] * tensor[symmetric_index<D>(a < b ? a : b, a < b ? b : a)] * e[b];
    return sum;
}

/// The equations of one pair; see passes.hpp for the source. e points from j to i, s runs along it.
template <int D, class Options>
GodunovForce<D> godunov_pair(const GodunovParticle<D>& i, const GodunovParticle<D>& j,
                             const Gaussian<D>& kernel, const Settings& settings, double time_step) {
    constexpr double root_half = 0.70710678118654752;
    std::array<double, D> r, e;
    double r2 = 0;
    for (int d = 0; d < D; ++d) {
        r[d] = i.x[d] - j.x[d];
        r2 += r[d] * r[d];
    }
    const double distance = std::sqrt(std::max(r2, 1e-300)), inverse_distance = 1 / distance;
    for (int d = 0; d < D; ++d) e[d] = r[d] * inverse_distance;

    // Specific volume between the particles.
    const bool compressed = i.pressure + j.pressure > 0;
    const Interpolation wanted = compressed ? settings.compressed : settings.stretched;
    VolumeEnds ends{
        1 / i.density, 1 / j.density, along<D>(i.volume_gradient, e), along<D>(j.volume_gradient, e), 0, 0};
    if constexpr (Options::quintic) {
        ends.curve_i = normal_component<D>(i.curvature, e);
        ends.curve_j = normal_component<D>(j.curvature, e);
    }
    const double mean_density = 0.5 * (i.density + j.density);
    const double largest_square = 10 / (mean_density * mean_density);
    const CubicCoefficients smooth =
        interpolate_volume(ends, inverse_distance, wanted != Interpolation::linear);
    const CubicCoefficients straight = interpolate_volume(ends, inverse_distance, false);
    const auto moments = [&](double h) {
        const double h2 = h * h;
        VolumeMoments m = cubic_moments(smooth.a, smooth.b, smooth.c, smooth.d, h2);
        if constexpr (Options::quintic) {
            const VolumeMoments q = quintic_volume(ends, distance, inverse_distance, h2);
            m.square = wanted == Interpolation::quintic ? q.square : m.square;
            m.centre = wanted == Interpolation::quintic ? q.centre : m.centre;
        }
        const double c = straight.c, d = straight.d;
        const double line_square = 0.25 * h2 * c * c + d * d;
        const bool too_large = m.square > largest_square;
        m.centre = too_large ? 0.5 * h2 * c * d / line_square : m.centre;
        m.square = too_large ? line_square : m.square;
        return m;
    };
    VolumeMoments volume = moments(i.h);
    double weight = 2 * volume.square * kernel.factor(r2, root_half / i.h);
    if constexpr (Options::variable_h) {
        const VolumeMoments other = moments(j.h);
        weight = 0.5 * weight + other.square * kernel.factor(r2, root_half / j.h);
        volume.centre = 0.5 * (volume.centre + other.centre);
    }

    // Riemann problem between states reconstructed at s*, centred in time.
    const double v_i = along<D>(i.v, e), v_j = along<D>(j.v, e);
    double star_pressure = 0.5 * (i.pressure + j.pressure);
    const double share = volume.centre * inverse_distance;  // s*/distance
    double star_velocity = 0.5 * (v_i + v_j) + (v_i - v_j) * share;
    if (settings.riemann) {
        // No state may lie outside the two values, whose difference the gradients, being smooth, exceed next
        // to jumps; first order at compressions that are fast against sound.
        const double v_secant = (v_i - v_j) * inverse_distance,
                     p_secant = (i.pressure - j.pressure) * inverse_distance;
        const double v_slope_i = limited_slope(stretch<D>(i.velocity_gradient, e), v_secant),
                     v_slope_j = limited_slope(stretch<D>(j.velocity_gradient, e), v_secant);
        const double p_slope_i = limited_slope(along<D>(i.pressure_gradient, e), p_secant),
                     p_slope_j = limited_slope(along<D>(j.pressure_gradient, e), p_secant);
        const bool gentle = settings.second_order && 3 * (v_j - v_i) < std::min(i.sound_speed, j.sound_speed);
        const double keep_v = gentle && v_slope_i * v_slope_j > 0 ? 1.0 : 0.0;
        const double keep_p = gentle && p_slope_i * p_slope_j > 0 ? 1.0 : 0.0;
        const double reach_i = volume.centre + 0.5 * (i.sound_speed * time_step - distance);
        const double reach_j = volume.centre - 0.5 * (j.sound_speed * time_step - distance);
        const RiemannSide right{i.density, i.pressure + keep_p * p_slope_i * reach_i,
                                v_i + keep_v * v_slope_i * reach_i, i.sound_speed};
        const RiemannSide left{j.density, j.pressure + keep_p * p_slope_j * reach_j,
                               v_j + keep_v * v_slope_j * reach_j, j.sound_speed};
        const RiemannSolution star = solve_riemann(left, right, settings.shock_slope);
        const bool false_tension = star.pressure < 0 && i.pressure > 0 && j.pressure > 0;
        star_pressure = false_tension ? star_pressure : star.pressure;
        star_velocity = settings.riemann_velocity ? star.velocity : star_velocity;
    }

    // Traction and its work at the velocity between the particles.
    GodunovForce<D> result;
    const double mean_normal = 0.5 * (v_i + v_j) + (v_i - v_j) * share;
    const bool contact = Options::bodies && i.body != j.body;
    if (contact) star_pressure = std::max(star_pressure, 0.0);
    std::array<double, D> traction;
    for (int a = 0; a < D; ++a) traction[a] = -star_pressure * r[a];
    if constexpr (Options::strength) {
        const double keep = contact ? 0.0 : 1.0;
        for (int a = 0; a < D; ++a)
            for (int b = 0; b < D; ++b) {
                const int k = symmetric_index<D>(a < b ? a : b, a < b ? b : a);
                traction[a] +=
                    keep * (0.5 * (i.stress[k] + j.stress[k]) + (i.stress[k] - j.stress[k]) * share) * r[b];
            }
    }
    result.power = 0;
    for (int a = 0; a < D; ++a) {
        const double star =
            0.5 * (i.v[a] + j.v[a]) + (i.v[a] - j.v[a]) * share + (star_velocity - mean_normal) * e[a];
        result.force[a] = weight * traction[a];
        result.power += result.force[a] * star;
    }
    return result;
}

template <int D, class Options>
class GodunovPass {
  public:
    GodunovPass(ParticleSet& particles, const Settings& settings, double time_step)
        : kernel_(settings.cutoff),
          settings_(settings),
          time_step_(time_step),
          position_(components<D>(particles, field::position)),
          velocity_(components<D>(particles, field::predicted_velocity)),
          volume_gradient_(components<D>(particles, field::volume_gradient)),
          pressure_gradient_(components<D>(particles, field::pressure_gradient)),
          velocity_gradient_(components<D * D>(particles, field::velocity_gradient)),
          acceleration_(components_to_write<D>(particles, field::acceleration)),
          power_(particles.data(field::specific_power)) {
        scalars_ = {particles.data(field::mass), particles.data(field::predicted_density),
                    particles.data(field::pressure), particles.data(field::sound_speed),
                    particles.data(field::smoothing_length)};
        if constexpr (Options::bodies) body_ = particles.data(field::body);
        if constexpr (Options::strength)
            stress_ = components<symmetric_count<D>>(particles, field::predicted_stress);
        if constexpr (Options::quintic)
            curvature_ = components<symmetric_count<D>>(particles, field::volume_curvature);
    }

    /// Work done on all particles of a cell; returns the number of pairs.
    std::uint64_t visit(const CellEntry& cell, std::span<const Run> runs) {
        std::uint64_t pairs = 0;
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            find(i, runs);
            gather();
            evaluate(i);
            pairs += partners_.count();
        }
        return pairs;
    }

  private:
    enum Scalar { mass, density, pressure, sound_speed, smoothing_length, scalar_count };

    void find(std::uint32_t i, std::span<const Run> runs) {
        const double reach2 = 2 * kernel_.support() * kernel_.support();
        const double* h = scalars_[smoothing_length];
        const double h_i = h[i];
        if constexpr (Options::variable_h)
            partners_.find(position_, i, runs, [=](std::uint32_t k) {
                const double larger = std::max(h_i, h[k]);
                return reach2 * larger * larger;
            });
        else
            partners_.find(position_, i, runs, [=](std::uint32_t) { return reach2 * h_i * h_i; });
    }

    void gather() {
        x_.gather(partners_, position_);
        v_.gather(partners_, velocity_);
        volume_gradients_.gather(partners_, volume_gradient_);
        pressure_gradients_.gather(partners_, pressure_gradient_);
        velocity_gradients_.gather(partners_, velocity_gradient_);
        scalar_values_.gather(partners_, scalars_);
        if constexpr (Options::bodies) partners_.gather(body_, bodies_);
        if constexpr (Options::strength) stresses_.gather(partners_, stress_);
        if constexpr (Options::quintic) curvatures_.gather(partners_, curvature_);
    }

    GodunovParticle<D> load(std::size_t k, const auto& x, const auto& v, const auto& dv, const auto& dp,
                            const auto& gv, const auto& scalars, const auto& s, const auto& curvature,
                            const auto* body) const {
        GodunovParticle<D> p;
        for (int d = 0; d < D; ++d) {
            p.x[d] = x[d][k];
            p.v[d] = v[d][k];
            p.volume_gradient[d] = dv[d][k];
            p.pressure_gradient[d] = dp[d][k];
        }
        for (int c = 0; c < D * D; ++c) p.velocity_gradient[c] = gv[c][k];
        p.mass = scalars[mass][k];
        p.density = scalars[density][k];
        p.pressure = scalars[pressure][k];
        p.sound_speed = scalars[sound_speed][k];
        p.h = scalars[smoothing_length][k];
        p.body = 0;
        if constexpr (Options::bodies) p.body = static_cast<double>(body[k]);
        if constexpr (Options::strength)
            for (int c = 0; c < symmetric_count<D>; ++c) p.stress[c] = s[c][k];
        if constexpr (Options::quintic)
            for (int c = 0; c < symmetric_count<D>; ++c) p.curvature[c] = curvature[c][k];
        return p;
    }

    void evaluate(std::uint32_t i) {
        const std::size_t n = partners_.count();
        const GodunovParticle<D> own = load(i, position_, velocity_, volume_gradient_, pressure_gradient_,
                                            velocity_gradient_, scalars_, stress_, curvature_, body_);
        const auto x = x_.data(), v = v_.data(), dv = volume_gradients_.data(),
                   dp = pressure_gradients_.data();
        const auto gv = velocity_gradients_.data();
        const auto scalars = scalar_values_.data();
        const auto s = stresses_.data(), curvature = curvatures_.data();
        const double* body = bodies_.data();
        std::array<double*, D + 1> terms;
        for (int d = 0; d <= D; ++d) {
            terms_[d].reserve(n);
            terms[d] = terms_[d].data();
        }
        const Gaussian<D> kernel = kernel_;
        const Settings settings = settings_;
        const double time_step = time_step_;
#pragma omp simd
        for (std::size_t k = 0; k < n; ++k) {
            const GodunovParticle<D> other = load(k, x, v, dv, dp, gv, scalars, s, curvature, body);
            const GodunovForce<D> term = godunov_pair<D, Options>(own, other, kernel, settings, time_step);
            for (int d = 0; d < D; ++d) terms[d][k] = other.mass * term.force[d];
            terms[D][k] = other.mass * term.power;
        }
        for (int d = 0; d <= D; ++d) {
            double total = 0;
            const double* term = terms[d];
#pragma omp simd reduction(+ : total)
            for (std::size_t k = 0; k < n; ++k) total += term[k];
            (d < D ? acceleration_[d < D ? d : 0] : power_)[i] = total;
        }
    }

    const Gaussian<D> kernel_;
    const Settings settings_;
    const double time_step_;
    std::array<const double*, D> position_, velocity_, volume_gradient_, pressure_gradient_;
    std::array<const double*, D * D> velocity_gradient_;
    std::array<const double*, scalar_count> scalars_;
    std::array<const double*, symmetric_count<D>> stress_{}, curvature_{};
    const std::uint8_t* body_ = nullptr;
    std::array<double*, D> acceleration_;
    double* power_;

    Partners<D> partners_;
    PartnerValues<D> x_, v_, volume_gradients_, pressure_gradients_;
    PartnerValues<D * D> velocity_gradients_;
    PartnerValues<scalar_count> scalar_values_;
    PartnerValues<symmetric_count<D>> stresses_, curvatures_;
    AlignedValues bodies_;
    std::array<AlignedValues, D + 1> terms_;
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
