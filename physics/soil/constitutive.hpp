#pragma once
#include <array>
#include <string>
#include <variant>

#include "physics/solid/plasticity.hpp"

namespace talus::soil {

/// Stress or strain: xx yy zz xy xz yz, tension positive; strains as tensors (e_xy, not 2 e_xy).
using Tensor = std::array<double, 6>;

double trace(const Tensor& t);
Tensor deviator(const Tensor& t);
/// a : b.
double contraction(const Tensor& a, const Tensor& b);
/// sqrt(3 J2) of a stress [Pa].
double mises_stress(const Tensor& stress);

/// Isotropic linear elasticity. A bar in 1D may be free to contract across: the stress is then uniaxial.
struct Elasticity {
    double youngs_modulus = 0;  ///< [Pa]
    double poisson_ratio = 0;   ///< [1]
    bool uniaxial_stress = false;

    double shear_modulus() const { return youngs_modulus / (2 * (1 + poisson_ratio)); }
    double bulk_modulus() const { return youngs_modulus / (3 * (1 - 2 * poisson_ratio)); }
    /// Of waves of compression [Pa].
    double wave_modulus() const {
        return uniaxial_stress ? youngs_modulus : bulk_modulus() + 4.0 / 3 * shear_modulus();
    }
    Tensor stress_of(const Tensor& strain) const;
    /// Elastic energy a volume [J/m3].
    double energy(const Tensor& stress) const;
};

/// Overstress law of P. Perzyna, Adv. Appl. Mech. 9 (1966) 243: the rate of viscoplastic strain is
/// fluidity * (F / reference)^exponent dg/dsigma where F > 0.
struct Overstress {
    double fluidity = 0;   ///< [1/s]
    double exponent = 1;   ///< [1]
    double reference = 0;  ///< [Pa]
};

/// What a point of soil has been through.
struct History {
    double strain = 0;            ///< accumulated deviatoric viscoplastic strain, sqrt(2/3 e:e) [1]
    double work = 0;              ///< [J/m3]
    double preconsolidation = 0;  ///< modified Cam-Clay only [Pa]
};

/// Of a yield surface at a stress: how far beyond it, in the unit of Overstress::reference, and the
/// direction of flow.
struct Yielding {
    double excess;  ///< [Pa]
    Tensor flow;    ///< dg/dsigma [1]
};

/// F = sqrt(3 J2) - Y, Y = yield_stress + hardening * strain, not below `residual`.
struct VonMises {
    double yield_stress = 0;  ///< [Pa]
    double hardening = 0;     ///< negative: softening [Pa]
    double residual = 0;      ///< [Pa]

    Yielding at(const Tensor& stress, const History& history, double strength_factor) const;
    /// Of return from beyond the surface, over fluidity / reference [Pa].
    double fastest_rate(const Elasticity& elasticity) const;
};

/// F = sqrt(J2) + alpha I1 - k of a cohesion and an angle of friction; the flow has its own angle.
/// D. C. Drucker, W. Prager, Quart. Appl. Math. 10 (1952) 157. Tension beyond the apex of the cone relaxes to
/// it whatever the dilation.
struct DruckerPrager {
    double cohesion = 0;   ///< [Pa]
    double friction = 0;   ///< tan of the angle [1]
    double dilation = 0;   ///< tan of the angle of the potential, not above that of friction [1]
    double hardening = 0;  ///< of the cohesion with strain, negative: softening [Pa]
    double residual = 0;   ///< least cohesion [Pa]
    ConeMatch match = ConeMatch::plane_strain;

    Yielding at(const Tensor& stress, const History& history, double strength_factor) const;
    double fastest_rate(const Elasticity& elasticity) const;
};

/// F = (q^2 / M^2 + p (p - p_c)) / p_c, p = -I1/3: modified Cam-Clay, K. H. Roscoe, J. B. Burland (1968), in
/// units of stress. p_c follows the volumetric viscoplastic strain.
struct CamClay {
    double slope = 0;             ///< M of the critical state line [1]
    double compression = 0;       ///< lambda [1]
    double swelling = 0;          ///< kappa [1]
    double void_ratio = 0;        ///< e [1]
    double preconsolidation = 0;  ///< at the start [Pa]

    Yielding at(const Tensor& stress, const History& history, double strength_factor) const;
    double fastest_rate(const Elasticity& elasticity) const;
    /// d p_c / p_c for a volumetric viscoplastic strain, compression positive.
    double hardening_rate() const { return (1 + void_ratio) / (compression - swelling); }
};

struct Elastic {};
using YieldSurface = std::variant<Elastic, VonMises, DruckerPrager, CamClay>;

/// A soil.
struct Material {
    std::string name;
    double density = 0;  ///< of the mixture [kg/m3]
    Elasticity elasticity;
    Overstress overstress;
    YieldSurface surface;
    double permeability = 0;  ///< of Darcy's law over the water's weight, k_w [m3 s/kg]
    double storage = 0;       ///< 1/Q: (1 - n)/K_s + n/K_w [1/Pa]

    double wave_speed() const;  ///< of compression, drained [m/s]
    bool flows() const { return !std::holds_alternative<Elastic>(surface); }
};

/// Relaxes the stress at a fixed strain over `time_step`: Runge-Kutta of fourth order in steps short against
/// the time in which the stress returns from as far beyond the surface as it is. Nothing happens within the
/// surface. False, with nothing done, if it took more than 10000 steps or they are too short for
/// numbers.
bool relax(const Material& material, double strength_factor, double time_step, Tensor& stress,
           History& history);

}  // namespace talus::soil
