#pragma once
#include <algorithm>
#include <cmath>

namespace talus::water {

/// A fluid that flows above a yield stress: the shear stress is tau_y + K rate^n where that is less than
/// mu_max rate, else mu_max rate: below the yield stress it is a fluid of viscosity mu_max. W. H. Herschel,
/// R. Bulkley, Kolloid-Zeitschrift 39 (1926) 291; with n = 1 the bi-viscosity model of C. R. Beverly, R. I.
/// Tanner, J. Non-Newtonian Fluid Mech. 42 (1992) 85.
struct Rheology {
    double yield_stress = 0;        ///< tau_y [Pa]
    double consistency = 0;         ///< K [Pa s^n]
    double exponent = 1;            ///< n [1]
    double greatest_viscosity = 0;  ///< mu_max [Pa s]

    /// Shear stress over the rate of shear [Pa s]; the rate is sqrt(2 D : D) of the rate of strain D [1/s].
    double viscosity(double rate) const {
        constexpr double nearly_at_rest = 1e-30;
        const double moving = std::max(rate, nearly_at_rest);
        return std::min(greatest_viscosity,
                        yield_stress / moving + consistency * std::pow(moving, exponent - 1));
    }
    /// The rate at which the stress reaches the yield stress: matter that has not yielded is sheared more
    /// slowly [1/s].
    double creep_rate() const { return yield_stress / greatest_viscosity; }
};

}  // namespace talus::water
