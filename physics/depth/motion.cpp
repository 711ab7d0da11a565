#include "physics/depth/motion.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "domain/depth_fields.hpp"
#include "domain/pore_pressure_field.hpp"
#include "domain/two_phase_fields.hpp"
#include "physics/sph/pass_support.hpp"

namespace talus::depth {

namespace {

/// What a particle's speed and friction need of the bed under it.
template <int D>
class Bed {
  public:
    Bed(const ParticleSet& particles, const Settings& settings) : settings_(settings) {
        if (settings.form == Form::cartesian) return;
        slope_ = sph::components<D>(particles, field::bed_slope);
        apparent_ = particles.data(field::apparent_gravity);
    }
    /// Along the surface.
    double speed(std::size_t i, const std::array<double, D>& v) const {
        double speed2 = 0, rise = 0;
        for (std::size_t d = 0; d < D; ++d) {
            speed2 += v[d] * v[d];
            if (apparent_) rise += slope_[d][i] * v[d];
        }
        return std::sqrt(speed2 + rise * rise);
    }
    double gravity(std::size_t i) const {
        if (!apparent_) return settings_.gravity;
        return normal_gravity(settings_, apparent_[i], cosine(i));
    }
    /// Of the angle between its normal and the vertical.
    double cosine(std::size_t i) const {
        if (!apparent_) return 1;
        std::array<double, D> slope;
        for (std::size_t d = 0; d < D; ++d) slope[d] = slope_[d][i];
        return Tilt(slope).cosine;
    }

  private:
    const Settings& settings_;
    std::array<const double*, D> slope_{};
    const double* apparent_ = nullptr;
};

/// Whether a column at rest feels no more than what rounding makes of a balance.
template <int D>
bool is_held(const std::array<const double*, D>& v, const std::array<const double*, D>& a, std::size_t i,
             double gravity) {
    constexpr double rounding = 1e-10;  // a hundred times that of the sums, over gravity
    double acceleration2 = 0;
    for (std::size_t d = 0; d < D; ++d) {
        if (v[d][i] != 0) return false;
        acceleration2 += a[d][i] * a[d][i];
    }
    return acceleration2 < rounding * gravity * (rounding * gravity);
}

/// Which columns a law of the bed acts on: of two phases one, or all.
struct Bedded {
    double density;                    ///< [kg/m3]
    const double* is_water = nullptr;  ///< in all columns, if there are phases
    const double* other_height = nullptr;
    double of_water = 0;  ///< value of is_water in those that are meant

    bool is_meant(std::size_t i) const { return !is_water || is_water[i] == of_water; }
};

template <int D, class Law>
void advance(ParticleSet& particles, const Settings& settings, const Bedded& bedded, const Law& law,
             double time, const Field<double>& to) {
    const auto v = sph::components<D>(particles, field::velocity),
               a = sph::components<D>(particles, field::acceleration);
    const auto moved = sph::components_to_write<D>(particles, to);
    const double* depth = particles.data(field::depth);
    const double* pore_pressure =
        particles.has(field::excess_pore_pressure) ? particles.data(field::excess_pore_pressure) : nullptr;
    const Bed<D> bed(particles, settings);
    const auto pressure_in_pores = [&](std::size_t i) {
        const double excess = pore_pressure ? pore_pressure[i] : 0;
        if (!bedded.is_water || bedded.of_water != 0) return excess;
        const TwoPhase& phases = *settings.two_phase;
        return excess + phases.saturation(bedded.other_height[i] * bed.cosine(i) / depth[i]) *
                            phases.water_density * bed.gravity(i) * depth[i];
    };
    for (std::size_t i = 0; i < particles.size(); ++i) {
        if (!bedded.is_meant(i)) continue;
        std::array<double, D> v_i;
        for (std::size_t d = 0; d < D; ++d) v_i[d] = v[d][i] + time * a[d][i];
        if (settings.balance && is_held<D>(v, a, i, settings.gravity)) v_i = {};
        if constexpr (!std::is_same_v<Law, Frictionless>) {
            const Column column{.depth = depth[i],
                                .density = bedded.density,
                                .normal_stress = bedded.density * bed.gravity(i) * depth[i],
                                .pore_pressure = pressure_in_pores(i),
                                .gravity = settings.gravity};
            const double before = bed.speed(i, v_i);
            const double kept = before > 0 ? law.speed_after(before, time, column) / before : 0;
            for (double& component : v_i) component *= kept;
        }
        for (std::size_t d = 0; d < D; ++d) moved[d][i] = v_i[d];
    }
}

void advance(ParticleSet& particles, const Settings& settings, const Bedded& bedded,
             const BasalFriction& friction, double time, const Field<double>& to) {
    std::visit(
        [&](const auto& law) {
            if (particles.dimension() == 1)
                advance<1>(particles, settings, bedded, law, time, to);
            else
                advance<2>(particles, settings, bedded, law, time, to);
        },
        friction);
}

void advance(ParticleSet& particles, const Settings& settings, const BasalFriction& friction, double time,
             const Field<double>& to) {
    if (!settings.two_phase)
        return advance(particles, settings, Bedded{settings.density}, friction, time, to);
    const TwoPhase& phases = *settings.two_phase;
    const double *is_water = particles.data(field::is_water), *other = particles.data(field::other_height);
    advance(particles, settings, Bedded{phases.solid_density, is_water, other, 0}, friction, time, to);
    advance(particles, settings, Bedded{phases.water_density, is_water, other, 1}, phases.water_friction,
            time, to);
}

template <int D>
void drift_and_take_up(ParticleSet& particles, const Settings& settings, double time) {
    const auto x = sph::components_to_write<D>(particles, field::position),
               v = sph::components_to_write<D>(particles, field::velocity);
    double* volume = particles.data(field::volume);
    const Bed<D> bed(particles, settings);
    for (std::size_t i = 0; i < particles.size(); ++i) {
        std::array<double, D> v_i;
        for (std::size_t d = 0; d < D; ++d) v_i[d] = v[d][i];
        const double taken = settings.entrainment * bed.speed(i, v_i) * time;
        const double way = taken > 0 ? std::log1p(taken) / taken : 1;  // in terms of the first velocity's
        volume[i] *= 1 + taken;
        for (std::size_t d = 0; d < D; ++d) {
            x[d][i] += v_i[d] * time * way;
            v[d][i] = v_i[d] / (1 + taken);
        }
    }
}

}  // namespace

void kick(ParticleSet& particles, const Settings& settings, const BasalFriction& friction, double time) {
    advance(particles, settings, friction, time, field::velocity);
}

void predict(ParticleSet& particles, const Settings& settings, const BasalFriction& friction, double time) {
    advance(particles, settings, friction, time, field::predicted_velocity);
}

void drift(ParticleSet& particles, const Settings& settings, double time) {
    if (settings.entrainment == 0 || settings.two_phase)
        sph::drift(particles, time);
    else if (particles.dimension() == 1)
        drift_and_take_up<1>(particles, settings, time);
    else
        drift_and_take_up<2>(particles, settings, time);
}

void fade_balance(ParticleSet& particles, double time) {
    const double* s = particles.data(field::smoothing_length);
    for (std::size_t i = 0; i < particles.size(); ++i) {
        double speed2 = 0;
        for (int axis = 0; axis < particles.dimension(); ++axis) {
            const double v = particles.data(field::velocity, axis)[i];
            speed2 += v * v;
        }
        const double left = std::exp(-std::sqrt(speed2) * time / s[i]);
        for (int axis = 0; axis < particles.dimension(); ++axis)
            particles.data(field::still_acceleration, axis)[i] *= left;
    }
}

sph::StepLimit stable_time_step(const ParticleSet& particles, const Settings& settings, double bed_length) {
    const double *s = particles.data(field::smoothing_length), *signal = particles.data(field::signal_speed);
    double by_signal = std::numeric_limits<double>::infinity(), by_acceleration = by_signal,
           by_bed = by_signal;
    std::size_t signal_at = 0, acceleration_at = 0, bed_at = 0;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        double acceleration2 = 0, speed2 = 0;
        for (int axis = 0; axis < particles.dimension(); ++axis) {
            const double a = particles.data(field::acceleration, axis)[i],
                         v = particles.data(field::velocity, axis)[i];
            acceleration2 += a * a;
            speed2 += v * v;
        }
        if (const double step = bed_length / std::sqrt(speed2); step < by_bed) {
            by_bed = step;
            bed_at = i;
        }
        if (const double step = s[i] / signal[i]; step < by_signal) {
            by_signal = step;
            signal_at = i;
        }
        if (const double step2 = s[i] / std::sqrt(acceleration2); step2 < by_acceleration) {
            by_acceleration = step2;
            acceleration_at = i;
        }
    }
    by_acceleration = std::sqrt(by_acceleration);
    const std::uint64_t* id = particles.data(field::id);
    if (particles.size() == 0) return {by_signal, 0, "no particles"};
    if (by_bed < std::min(by_signal, by_acceleration))
        return {settings.courant * by_bed, id[bed_at], "speed over the terrain"};
    if (by_signal < by_acceleration) return {settings.courant * by_signal, id[signal_at], "signals"};
    return {settings.courant * by_acceleration, id[acceleration_at], "acceleration"};
}

}  // namespace talus::depth
