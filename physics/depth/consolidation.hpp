#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace talus::depth {

/// What the bed does to the water in the pores of a flow.
enum class Base : std::uint8_t { impermeable, drained };

/// Excess pore pressure of flowing columns: it grows and falls with the load of a column that thickens or
/// thins and drains through the free surface by diffusion,
///
///     dp/dt = unit_weight (1 - zeta) dh/dt + c_v/h^2 d2p/dzeta2,   zeta = z/h,   p = 0 at zeta = 1.
///
/// A column that spreads is stretched evenly, so that material stays at its zeta. Undrained, the effective
/// stress of every layer is kept: what is liquefied stays so. Pressures below zero are set to zero: soil that
/// is stretched takes in air. K. Terzaghi, Erdbaumechanik (1925); M. Pastor, B. Haddad, G. Sorbino, S. Cuomo,
/// V. Drempetic, Int. J. Numer. Anal. Methods Geomech. 33 (2009) 143.
struct Consolidation {
    double coefficient;             ///< c_v [m2/s]
    double unit_weight;             ///< of what a growing depth adds to the load, per volume [N/m3]
    Base base = Base::impermeable;  ///< drained: for profiles only
};

/// Columns of `count` particles: their depths [m] before and after a time step.
struct ChangingDepths {
    std::span<const double> before, after;
};

/// The pressure of the first mode alone, p(zeta) = p_bed cos(pi zeta / 2), over an impermeable bed: one value
/// a particle, that at the bed [Pa], in place. The load is that at the bed; the decay over the time step is
/// exact. M. Pastor et al. (2009), as above.
void consolidate_first_mode(const Consolidation& law, const ChangingDepths& depths, double time_step,
                            std::span<double> bed_pressure);

/// Profiles: `pressure[k]` points to the values of all particles at zeta = k / n, k = 0 ... n - 1, in place.
/// Second order over the depth, implicit Euler in time, so that any time step is stable.
void consolidate_profile(const Consolidation& law, const ChangingDepths& depths, double time_step,
                         std::span<double* const> pressure);

/// Fills profiles with `ratio` times the load of the column above, as in soil that bears 1 - ratio of its
/// weight by its grains; a first mode (one value) with that at the bed.
void set_pore_pressure(double ratio, double unit_weight, std::span<const double> depth,
                       std::span<double* const> pressure);

}  // namespace talus::depth
