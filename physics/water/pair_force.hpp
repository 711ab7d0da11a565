#pragma once
#include <cmath>

#include "domain/float_lanes.hpp"
#include "physics/sph/kernels.hpp"
#include "physics/sph/small_vectors.hpp"
#include "physics/water/settings.hpp"

namespace talus::water {

/// Which viscosities the water of a scene has.
struct Viscosities {
    bool artificial, viscous;
};

/// The force of a pair of particles, in units of the radius of interaction R, the speed of sound c0 and the
/// density at rest rho0: F_ij/(V_i V_j) = scale() x^3 ((p_i + p_j + P_ij) r - f v), x = 1 - r/R, see
/// force_pass().
template <int D, Viscosities terms>
class PairForce {
  public:
    explicit PairForce(const Settings& settings)
        : damping_(static_cast<float>(settings.artificial_viscosity / Settings::support())),
          friction_(static_cast<float>(2 * settings.viscosity /
                                       (settings.state.reference_density * settings.state.sound_speed *
                                        settings.radius()))) {}

    /// grad W = -kernel() x^3 r/R^(D+2).
    static double kernel() { return 5 * sph::WendlandC2<D>::norm * std::pow(Settings::support(), D + 2); }
    /// Acceleration [m/s2] of a particle of density rho0 is this times the sum of V_j x^3 (...).
    static double scale(const Settings& settings) {
        return kernel() * settings.state.sound_speed * settings.state.sound_speed / settings.radius();
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
            if constexpr (terms.viscous) force[d] -= friction_ * sticks * v[d];
        }
        return force;
    }

  private:
    float damping_, friction_;
};

}  // namespace talus::water
