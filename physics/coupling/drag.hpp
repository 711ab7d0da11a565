#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>
#include <variant>

/// Drag of a fluid on one sphere among others. A law gives `resistance(slip)`: the force over 3 pi mu d
/// times the superficial slip velocity epsilon |u - v| [1], 1 for Stokes. It is the drag proper, which the
/// gradient of the pressure adds to (model A); Reynolds numbers are of the superficial slip,
/// Re = rho epsilon d |u - v| / mu.
namespace talus::coupling {

/// What a law knows of a grain and the fluid around it.
struct Slip {
    double fluid_fraction;  ///< epsilon [1]
    double reynolds;        ///< of the superficial slip [1]
};

/// Drag coefficient of one sphere, Stokes at low Reynolds numbers and 0.44 at high ones. L. Schiller, A.
/// Naumann, Z. Ver. Dtsch. Ing. 77 (1933) 318.
inline double schiller_naumann_coefficient(double reynolds) {
    return std::max(24 / reynolds * (1 + 0.15 * std::pow(reynolds, 0.687)), 0.44);
}

/// The force of a drag coefficient over that of Stokes.
inline double over_stokes(double coefficient, double reynolds) { return coefficient * reynolds / 24; }

/// One sphere in creeping flow. G. G. Stokes, Trans. Camb. Philos. Soc. 9 (1851) 8.
struct Stokes {
    static constexpr std::string_view name = "stokes";
    double resistance(const Slip& slip) const { return 1 / slip.fluid_fraction; }
};

/// One sphere at any Reynolds number: no grain knows of the others.
struct SchillerNaumann {
    static constexpr std::string_view name = "schiller_naumann";
    double resistance(const Slip& slip) const {
        const double single = slip.reynolds / slip.fluid_fraction;
        return over_stokes(schiller_naumann_coefficient(single), single) / slip.fluid_fraction;
    }
};

/// R. Di Felice, Int. J. Multiphase Flow 20 (1994) 153, with the coefficient of J. M. Dalla Valle,
/// Micromeritics (1948).
struct DiFelice {
    static constexpr std::string_view name = "di_felice";
    double resistance(const Slip& slip) const {
        const double root = 0.63 + 4.8 / std::sqrt(slip.reynolds), x = 1.5 - std::log10(slip.reynolds);
        const double chi = 3.7 - 0.65 * std::exp(-0.5 * x * x);
        return over_stokes(root * root, slip.reynolds) * std::pow(slip.fluid_fraction, -chi);
    }
};

/// C. Y. Wen, Y. H. Yu, Chem. Eng. Prog. Symp. Ser. 62 (1966) 100.
struct WenYu {
    static constexpr std::string_view name = "wen_yu";
    double resistance(const Slip& slip) const {
        return over_stokes(schiller_naumann_coefficient(slip.reynolds), slip.reynolds) *
               std::pow(slip.fluid_fraction, -3.65);
    }
};

/// Packed beds. S. Ergun, Chem. Eng. Prog. 48 (1952) 89.
struct Ergun {
    static constexpr std::string_view name = "ergun";
    double resistance(const Slip& slip) const {
        const double e = slip.fluid_fraction;
        return (150 * (1 - e) + 1.75 * slip.reynolds) / (18 * e * e);
    }
};

/// Ergun up to a fluid fraction of 0.8, Wen and Yu above. D. Gidaspow, Multiphase Flow and Fluidization
/// (1994).
struct Gidaspow {
    static constexpr std::string_view name = "gidaspow";
    double resistance(const Slip& slip) const {
        return slip.fluid_fraction <= 0.8 ? Ergun{}.resistance(slip) : WenYu{}.resistance(slip);
    }
};

/// The same without the step. L. Huilin, D. Gidaspow, Chem. Eng. Sci. 58 (2003) 3777, eq. 27.
struct HuilinGidaspow {
    static constexpr std::string_view name = "huilin_gidaspow";
    /// Of Wen and Yu's law [1].
    static double share(double fluid_fraction) {
        return std::atan(150 * 1.75 * (fluid_fraction - 0.8)) / std::numbers::pi + 0.5;
    }
    double resistance(const Slip& slip) const {
        const double dilute = share(slip.fluid_fraction);
        return (1 - dilute) * Ergun{}.resistance(slip) + dilute * WenYu{}.resistance(slip);
    }
};

/// D. L. Koch, R. J. Hill, Annu. Rev. Fluid Mech. 33 (2001) 619, as S. Benyahia, M. Syamlal, T. J. O'Brien,
/// Powder Technol. 162 (2006) 166 put it together for Reynolds numbers that matter.
struct KochHill {
    static constexpr std::string_view name = "koch_hill";
    double resistance(const Slip& slip) const {
        const double e = slip.fluid_fraction, phi = 1 - e;
        double still = 10 * phi / (e * e * e);
        if (phi < 0.4) {
            const double logarithm = phi > 0 ? phi * std::log(phi) : 0.0;
            still = (1 + 3 * std::sqrt(0.5 * phi) + 135.0 / 64 * logarithm + 16.14 * phi) /
                    (1 + phi * (0.681 + phi * (-8.48 + 8.16 * phi)));
        }
        const double inertial = 0.0673 + 0.212 * phi + 0.0232 / std::pow(e, 5);
        return e * (still + 0.5 * inertial * slip.reynolds);
    }
};

/// R. Beetstra, M. A. van der Hoef, J. A. M. Kuipers, AIChE J. 53 (2007) 489, eqs 16, 21.
struct Beetstra {
    static constexpr std::string_view name = "beetstra";
    double resistance(const Slip& slip) const {
        const double e = slip.fluid_fraction, phi = 1 - e, re = slip.reynolds;
        const double still = 10 * phi / (e * e) + e * e * (1 + 1.5 * std::sqrt(phi));
        const double moving = 0.413 * re / (24 * e * e) * (1 / e + 3 * e * phi + 8.4 * std::pow(re, -0.343)) /
                              (1 + std::pow(10.0, 3 * phi) * std::pow(re, -0.5 * (1 + 4 * phi)));
        return still + moving;
    }
};

/// All laws that a scene can name.
using DragLaw = std::variant<Stokes, SchillerNaumann, DiFelice, WenYu, Ergun, Gidaspow, HuilinGidaspow,
                             KochHill, Beetstra>;

/// How the mean momentum equations share the pressure: `a`: both fluid and grains feel its gradient. `b`: the
/// fluid feels all of it, grains the weight of the fluid that they displace, and the drag is greater by
/// 1/epsilon. D. Gidaspow (1994), section 2.4.
enum class PressureModel : std::uint8_t { a, b };

/// The fluid around a grain.
struct Surroundings {
    double density;         ///< of the fluid itself [kg/m3]
    double viscosity;       ///< [Pa s]
    double fluid_fraction;  ///< [1]
};

/// Drag for each slip velocity u - v of the interstitial fluid [N s/m]. At rest a slip is taken to be as
/// small as makes no difference. A fluid without viscosity has no drag here.
inline double drag_coefficient(const DragLaw& law, PressureModel model, const Surroundings& fluid,
                               double diameter, double speed) {
    constexpr double least_reynolds = 1e-6;
    if (fluid.viscosity == 0) return 0;
    const double e = fluid.fluid_fraction;
    const double reynolds = std::max(fluid.density * e * diameter * speed / fluid.viscosity, least_reynolds);
    const double resistance = std::visit([&](const auto& l) { return l.resistance({e, reynolds}); }, law);
    const double drag = 3 * std::numbers::pi * fluid.viscosity * diameter * e * resistance;
    return model == PressureModel::a ? drag : drag / e;
}

}  // namespace talus::coupling
