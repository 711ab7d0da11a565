#pragma once
#include <cstdint>
#include <span>

#include "domain/random.hpp"
#include "physics/solid/stress_state.hpp"

namespace talus {

/// Brittle fracture by the growth of cracks from Weibull-distributed flaws: n(eps) = k eps^m flaws per volume
/// open at a tensile strain below eps. D. E. Grady, M. E. Kipp, Int. J. Rock Mech. Min. Sci. 17 (1980) 147;
/// W. Benz, E. Asphaug, Icarus 107 (1994) 98 and Comput. Phys. Commun. 87 (1995) 253.
///
/// The cracks of a particle grow at the speed c_g and relieve a sphere each, D = sum over them of
/// (c_g t)^3 / R_s^3, so n cracks of one age give dD^(1/3)/dt = n^(1/3) c_g / R_s. Only this cube root keeps
/// D independent of the particle's size, for n grows as R_s^3, and gives Grady and Kipp's strength, rising
/// with the strain rate to the power 3/(m+3). Benz & Asphaug print n instead (`crack_count_power` = 1), under
/// which the exponent is 1/(m+1) and the strength falls as particles grow.
struct Fracture {
    double weibull_k;                      ///< [1/m3]
    double weibull_m;                      ///< [1]
    double crack_speed_fraction = 0.4;     ///< c_g in units of the longitudinal sound speed [1]
    double crack_count_power = 1.0 / 3.0;  ///< p of dD^(1/3)/dt = n^p c_g / R_s [1]
};

/// Flaws of one particle, compactly: n(eps) = min((eps/threshold)^exponent, count) are open at strain
/// eps >= threshold, none below. Exact at the weakest and at the strongest flaw; P. Sevecek et al., Astron.
/// Astrophys. 629 (2019) A122.
struct Flaws {
    float threshold = 0;      ///< strain that opens the weakest flaw [1]
    float exponent = 1;       ///< ln(count) / ln(strongest/weakest threshold) [1]
    std::uint32_t count = 0;  ///< flaws in all; 0: never cracks

    /// Number of open flaws at tensile strain `strain` [1]: 0, or between 1 and `count`, not an integer.
    double open(double strain) const;
};

/// Samples the flaws of any particle of a body without looking at the others.
///
/// Benz & Asphaug (1994) drop flaws j = 1, 2, ... of threshold (j/(kV))^(1/m) on random
/// particles of a body of volume V, until each of its N particles has one. Seen from a particle, j/N are the
/// points of a Poisson process of unit rate, ended at X = J/N where the last particle got its first flaw:
/// P(X < x) = (1 - e^-x)^N, the coupon collector's time, ln N + 0.577 in the mean. Given X, particles are
/// independent and each has at least one point below X. So X is drawn once per body, then each particle's
/// first point from the exponential distribution cut at X, then exponential gaps until X is passed.
/// Everything is addressed by the particle's id: the flaws depend on neither ranks nor storage order.
class FlawSampler {
  public:
    /// `volume` [m3] and `particles` are those of the whole body, over all ranks.
    FlawSampler(const Fracture& fracture, double volume, std::uint64_t particles, std::uint64_t seed,
                std::uint8_t body);

    Flaws sample(std::uint64_t id) const;

    /// Mean number of flaws per particle, given this body's X: X / (1 - e^-X).
    double mean_count() const;
    /// X, the number of dropped flaws per particle.
    double dropped_per_particle() const { return last_; }

  private:
    RandomStream stream_;
    double last_;                // X
    double inverse_m_;           // 1/m
    double weibull_m_;           // m
    double log_particle_flaws_;  // ln(k V/N)
};

/// The flaws of many particles, one value each (fields flaw_threshold, flaw_exponent, flaw_count).
struct FlawColumns {
    std::span<const float> threshold, exponent;
    std::span<const std::uint32_t> count;

    Flaws operator[](std::size_t i) const { return {threshold[i], exponent[i], count[i]}; }
};

/// What damage growth needs to know of a material and its resolution.
struct CrackGrowth {
    double crack_speed;        ///< c_g [m/s]
    double young_modulus;      ///< E = 9 K mu / (3 K + mu) [Pa]
    double crack_count_power;  ///< as in Fracture
};

/// The tensile strain that opens flaws: largest principal stress over Young's modulus, 0 under compression.
///
/// Benz & Asphaug divide the stress that cracked rock still carries by (1 - D) E, to get back to the strain
/// of its uncracked part. Here P and S come as that part has them (P before its reduction by 1 - D, S never
/// reduced by it), so the factor has cancelled already: dividing again would count it twice, and D = 1 needs
/// no special care.
template <int dimension>
double tensile_strain(double pressure, const Deviator& stress, double young_modulus) {
    double largest;
    if constexpr (dimension == 1) {
        largest = std::max(stress.xx, stress.yy);
    } else if constexpr (dimension == 2) {
        const double half = 0.5 * (stress.xx - stress.yy);
        largest = std::max(0.5 * (stress.xx + stress.yy) + std::sqrt(half * half + stress.xy * stress.xy),
                           stress.zz);
    } else {
        largest = largest_principal(stress);
    }
    return std::max((largest - pressure) / young_modulus, 0.0);
}

/// Rate of D^(1/3) [1/s] and the most that D may reach while only `open` of `count` flaws are open.
struct DamageRate {
    double rate = 0, limit = 0;
};

/// `radius` R_s [m] is the distance over which a crack relieves a particle: the kernel's support.
/// D <= (open/count)^(1/3), as in K. Sugiura, H. Kobayashi, S. Inutsuka, Astron. Astrophys. 620 (2018) A167:
/// a particle breaks fully only when all its flaws are open.
DamageRate damage_rate(const CrackGrowth& growth, const Flaws& flaws, double strain, double radius);

/// The state that cracks grow in, one value a particle.
struct FractureState {
    FlawColumns flaws;
    std::span<const double> pressure;    ///< of the equation of state, before its reduction by damage [Pa]
    StressColumns<const double> stress;  ///< deviatoric stress within the strength [Pa]
    std::span<const double> radius;      ///< smoothing lengths [m]
    double radius_factor;                ///< R_s in smoothing lengths [1]
};

/// Advances the damage of all particles with body == which by dt [s]; it never shrinks.
void grow_damage(const CrackGrowth& growth, const FractureState& state, double dt, std::span<double> damage,
                 std::span<const std::uint8_t> body, std::uint8_t which);

/// Longest step [s] in which D^(1/3), which cracks make grow at a constant rate, gains no more than `most` in
/// any particle with body == which; infinite if none is growing. A particle with less than `most` to go to
/// its limit does not count. The code of C. Schaefer et al., Astron. Comput. 33
/// (2020) 100410, has such a limit, of 0.01 to 0.15.
double damage_time_step(const CrackGrowth& growth, const FractureState& state, double most,
                        std::span<const double> damage, std::span<const std::uint8_t> body,
                        std::uint8_t which);

}  // namespace talus
