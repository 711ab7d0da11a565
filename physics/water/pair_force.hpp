#pragma once
#include <array>
#include <cmath>
#include <cstdint>

#include "domain/float_lanes.hpp"
#include "domain/particles.hpp"
#include "domain/water_fields.hpp"
#include "physics/sph/kernels.hpp"
#include "physics/sph/small_vectors.hpp"
#include "physics/water/settings.hpp"

namespace talus::water {

/// Which viscosities the water of a scene has.
enum class Viscosity : std::uint8_t { none, even, uneven };
struct Viscosities {
    bool artificial;
    Viscosity laminar;
};

/// Calls run.operator()<viscosities>() with those of the settings.
template <class Run>
void with_viscosities(const Settings& settings, Run&& run) {
    const auto with_artificial = [&]<bool artificial>() {
        if (settings.rheology)
            run.template operator()<Viscosities{artificial, Viscosity::uneven}>();
        else if (settings.viscosity > 0)
            run.template operator()<Viscosities{artificial, Viscosity::even}>();
        else
            run.template operator()<Viscosities{artificial, Viscosity::none}>();
    };
    if (settings.artificial_viscosity > 0)
        with_artificial.template operator()<true>();
    else
        with_artificial.template operator()<false>();
}

/// Viscosity and gradient of the velocity of particles, where viscosity differs from place to place.
template <int D>
struct LocalFlow {
    static constexpr std::size_t value_count = 1 + std::size_t{D} * D;
    using Columns = std::array<const float*, value_count>;

    FloatLanes viscosity;                                 ///< over rho0 c0 R
    std::array<FloatLanes, std::size_t{D} * D> gradient;  ///< dv_a/dx_b over c0/R, row by row

    static Columns columns(const ParticleSet& particles) {
        Columns from{particles.data(water_field::partner_viscosity)};
        for (int c = 0; c < D * D; ++c)
            from[1 + static_cast<std::size_t>(c)] = particles.data(water_field::partner_gradient, c);
        return from;
    }
    static LocalFlow of(const Columns& from, std::uint32_t i) {
        return made([&](std::size_t c) { return FloatLanes(from[c][i]); });
    }
    static LocalFlow load(const float* const* from, std::size_t k) {
        return made([&](std::size_t c) { return talus::load(from[c] + k); });
    }

  private:
    template <class Value>
    static LocalFlow made(Value&& value) {
        LocalFlow flow{value(0), {}};
        for (std::size_t c = 1; c < value_count; ++c) flow.gradient[c - 1] = value(c);
        return flow;
    }
};

/// The harmonic mean of the viscosities and the mean of the gradients.
template <int D>
LocalFlow<D> between(const LocalFlow<D>& a, const LocalFlow<D>& b) {
    constexpr float nothing = 1e-20F;  // no division by zero where nothing is viscous
    LocalFlow<D> mean{2 * a.viscosity * b.viscosity / (a.viscosity + b.viscosity + nothing), {}};
    for (std::size_t c = 0; c < mean.gradient.size(); ++c)
        mean.gradient[c] = 0.5F * (a.gradient[c] + b.gradient[c]);
    return mean;
}

/// The force of a pair of particles, in units of the radius of interaction R, the speed of sound c0 and the
/// density at rest rho0: F_ij/(V_i V_j) = scale() x^3 ((p_i + p_j + P_ij) r - f v), x = 1 - r/R, see
/// force_pass().
template <int D, Viscosities terms>
class PairForce {
  public:
    explicit PairForce(const Settings& settings)
        : damping_(static_cast<float>(settings.artificial_viscosity / Settings::support())),
          friction_(static_cast<float>(
              2 * settings.viscosity /
              (settings.state.reference_density * settings.state.sound_speed * settings.radius()))),
          core_(static_cast<float>(settings.wall_core / settings.radius())),
          hardness_(settings.wall_core > 0 ? static_cast<float>(core_hardness) / core_ : 0) {}

    /// grad W = -kernel() x^3 r/R^(D+2).
    static double kernel() { return 5 * sph::WendlandC2<D>::norm * std::pow(Settings::support(), D + 2); }
    /// Acceleration [m/s2] of a particle of density rho0 is this times the sum of V_j x^3 (...).
    static double scale(const Settings& settings) {
        return kernel() * settings.state.sound_speed * settings.state.sound_speed / settings.radius();
    }

    /// What a particle of a wall adds to the pressure within its core.
    FloatLanes core_pressure(const FloatLanes& distance) const {
        return hardness_ * max(core_ - distance, FloatLanes(0.0F));
    }
    /// What stands in the brackets; `pressure`: of both, `sticks`: 0 if the pair has no viscosity, else 1.
    sph::Vector<FloatLanes, D> operator()(const sph::Vector<FloatLanes, D>& r,
                                          const sph::Vector<FloatLanes, D>& v, const FloatLanes& r2,
                                          FloatLanes pressure, const FloatLanes& sticks) const {
        constexpr float softening = 0.01F / static_cast<float>(Settings::support() * Settings::support());
        if constexpr (terms.artificial)
            pressure -= damping_ * sticks * min(sph::dot(r, v), FloatLanes(0.0F)) / (r2 + softening);
        sph::Vector<FloatLanes, D> force;
        for (int d = 0; d < D; ++d) {
            force[d] = pressure * r[d];
            if constexpr (terms.laminar == Viscosity::even) force[d] -= friction_ * sticks * v[d];
        }
        return force;
    }
    /// The same with the viscosity and the gradient of the velocity between the two.
    sph::Vector<FloatLanes, D> operator()(const sph::Vector<FloatLanes, D>& r,
                                          const sph::Vector<FloatLanes, D>& v, const FloatLanes& r2,
                                          const FloatLanes& pressure, const FloatLanes& sticks,
                                          const LocalFlow<D>& flow) const {
        sph::Vector<FloatLanes, D> force = (*this)(r, v, r2, pressure, sticks);
        const FloatLanes friction = 2 * flow.viscosity * sticks;
        for (std::size_t a = 0; a < D; ++a) {
            FloatLanes shear = v[a];
            for (std::size_t b = 0; b < D; ++b) shear += flow.gradient[D * b + a] * r[b];
            force[a] -= friction * shear;
        }
        return force;
    }

  private:
    float damping_, friction_, core_, hardness_;
};

}  // namespace talus::water
