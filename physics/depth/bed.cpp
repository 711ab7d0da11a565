#include <algorithm>
#include <cmath>

#include "domain/depth_fields.hpp"
#include "domain/two_phase_fields.hpp"
#include "physics/depth/kernel.hpp"
#include "physics/depth/motion.hpp"
#include "physics/depth/passes.hpp"
#include "physics/sph/pass_support.hpp"

namespace talus::depth {

namespace {

/// v . curvature . v of the surface z(x, y) [m/s2]
template <int D>
double centripetal(const TerrainPoint& ground, const std::array<double, D>& v) {
    double sum = ground.curvature[0] * v[0] * v[0];
    if constexpr (D == 2) sum += ground.curvature[1] * v[1] * v[1] + 2 * ground.curvature[2] * v[0] * v[1];
    return sum;
}

template <int D>
void meet(ParticleSet& particles, const Terrain& terrain, const Settings& settings) {
    const auto x = sph::components<D>(particles, field::position),
               v = sph::components<D>(particles, field::predicted_velocity);
    const double* height = particles.data(field::column_height);
    const auto next = std::as_const(particles).own(field::next_smoothing_length);
    std::copy(next.begin(), next.end(), particles.data(field::smoothing_length));
    double *depth = particles.data(field::depth), *wave_speed = particles.data(field::wave_speed);
    std::array<double*, D> slope{};
    if (particles.has(field::bed_slope)) slope = sph::components_to_write<D>(particles, field::bed_slope);
    double* factor = particles.data(field::pressure_factor);
    const double* earth_pressure = settings.earth_pressure ? particles.data(field::earth_pressure) : nullptr;
    const double stiffness = settings.earth_pressure ? settings.earth_pressure->stiffness() : 0;
    const bool fitted = settings.form == Form::bed_fitted;
    double* level = settings.gradient == Gradient::level ? particles.data(field::surface_level) : nullptr;
    double* apparent = fitted ? particles.data(field::apparent_gravity) : nullptr;
    const double half = 0.5 * lattice_factor<D>(settings);
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const TerrainPoint ground = terrain.at(x[0][i], D == 2 ? x[D - 1][i] : 0.0);
        for (std::size_t d = 0; d < D; ++d)
            if (slope[d]) slope[d][i] = ground.slope[d];
        Tilt tilt;
        if (fitted) {
            std::array<double, D> v_i, slope_i;
            for (std::size_t d = 0; d < D; ++d) {
                v_i[d] = v[d][i];
                slope_i[d] = ground.slope[d];
            }
            apparent[i] = settings.gravity + centripetal<D>(ground, v_i);
            tilt = Tilt(slope_i);
        }
        depth[i] = height[i] * tilt.cosine;
        // Without the pull of the bed's curvature: where a fast flow leaves a bump, columns that do not press
        // on the bed would not push each other apart either, and heap up in a point.
        const double along_normal = settings.gravity * tilt.cosine;
        const double in_plan = along_normal * tilt.cosine,
                     coefficient = earth_pressure ? earth_pressure[i] : 1;
        wave_speed[i] = std::sqrt((coefficient + 0.5 * stiffness) * in_plan * height[i]);
        factor[i] = level ? 0 : half * coefficient * in_plan;
        if (level) level[i] = ground.elevation + depth[i];
    }
}

template <int D>
void slide(ParticleSet& particles, const Settings& settings) {
    const auto a = sph::components_to_write<D>(particles, field::acceleration);
    const auto slope = sph::components<D>(particles, field::bed_slope);
    const bool fitted = settings.form == Form::bed_fitted;
    const double* apparent = fitted ? particles.data(field::apparent_gravity) : nullptr;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        std::array<double, D> slope_i;
        double along = fitted ? apparent[i] : settings.gravity;
        for (std::size_t d = 0; d < D; ++d) {
            slope_i[d] = slope[d][i];
            if (fitted) along += a[d][i] * slope_i[d];
        }
        if (fitted) along *= Tilt(slope_i).cosine2;
        for (std::size_t d = 0; d < D; ++d) a[d][i] -= along * slope_i[d];
    }
}

/// After meet(): what of the pressure within a phase the other one makes. Solid, (1 - w) h_s h/2 and w
/// h_s^2/2; water, h_w^2/2 + h_w h_s: its height over the ground counts, not that over the solid.
void meet_other_phase(ParticleSet& particles, const TwoPhase& phases) {
    const double *height = particles.data(field::column_height), *other = particles.data(field::other_height),
                 *is_water = particles.data(field::is_water);
    double *factor = particles.data(field::pressure_factor), *wave_speed = particles.data(field::wave_speed),
           *gravity = particles.data(field::lateral_gravity);
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const double ratio = other[i] / height[i];
        gravity[i] = wave_speed[i] * wave_speed[i] / height[i];
        const double greater = is_water[i] != 0 ? 1 + 2 * ratio : 1 + (1 - phases.buoyancy()) * ratio;
        factor[i] *= greater;
        // The fastest wave is that of both together; from column to column only the pressure within a phase
        // acts.
        wave_speed[i] *= std::sqrt(std::max(greater, 1 + ratio));
    }
}

}  // namespace

void meet_bed(ParticleSet& particles, const Terrain& terrain, const Settings& settings) {
    if (particles.dimension() == 1)
        meet<1>(particles, terrain, settings);
    else
        meet<2>(particles, terrain, settings);
    if (settings.two_phase) meet_other_phase(particles, *settings.two_phase);
}

void strain_earth_pressure(ParticleSet& particles, const EarthPressure& law, double time_step) {
    const double* divergence = particles.data(field::divergence);
    const double softening = law.stiffness() * time_step;
    for (double& coefficient : particles.own(field::earth_pressure))
        coefficient = std::clamp(coefficient - softening * *divergence++, law.active, law.passive);
}

void slide_on_bed(ParticleSet& particles, const Settings& settings) {
    if (settings.gradient == Gradient::potential && particles.has(field::bed_slope)) {
        if (particles.dimension() == 1)
            slide<1>(particles, settings);
        else
            slide<2>(particles, settings);
    }
    if (!settings.balance) return;
    for (int axis = 0; axis < particles.dimension(); ++axis) {
        double* a = particles.data(field::acceleration, axis);
        for (const double still : std::as_const(particles).own(field::still_acceleration, axis))
            *a++ -= still;
    }
}

}  // namespace talus::depth
