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
///     dp/dt = (1 - zeta) dq/dt + c_v/h^2 d2p/dzeta2,   zeta = z/h,   p = 0 at zeta = 1,
///
/// with q the part of the normal stress at the bed that loads the mixture of grains and water. A column that
/// spreads is stretched evenly, so that material stays at its zeta. Undrained, the effective stress of every
/// layer is kept: what is liquefied stays so. Pressures below zero are set to zero: soil that is stretched
/// takes in air. K. Terzaghi, Erdbaumechanik (1925); M. Pastor, B. Haddad, G. Sorbino, S. Cuomo, V.
/// Drempetic, Int. J. Numer. Anal. Methods Geomech. 33 (2009) 143.
struct Consolidation {
    double coefficient;             ///< c_v [m2/s]
    Base base = Base::impermeable;  ///< drained: for profiles only
};

/// Columns of particles after a time step, and their loads q before and after it.
struct LoadedColumns {
    std::span<const double> depth;                    ///< [m]
    std::span<const double> load_before, load_after;  ///< at the bed [Pa]
};

/// The pressure of the first mode alone, p(zeta) = p_bed cos(pi zeta / 2), over an impermeable bed: one value
/// a particle, that at the bed [Pa], in place. The load is that at the bed; the decay over the time step is
/// exact. M. Pastor et al. (2009), as above.
void consolidate_first_mode(const Consolidation& law, const LoadedColumns& columns, double time_step,
                            std::span<double> bed_pressure);

/// Profiles: `pressure[k]` points to the values of all particles at zeta = k / n, k = 0 ... n - 1, in place.
/// Second order over the depth, implicit Euler in time, so that any time step is stable.
void consolidate_profile(const Consolidation& law, const LoadedColumns& columns, double time_step,
                         std::span<double* const> pressure);

/// Fills profiles with `ratio` times the load of the column above, as in soil that bears the rest by its
/// grains; a first mode (one value) with that at the bed. `load`: at the bed [Pa].
void set_pore_pressure(double ratio, std::span<const double> load, std::span<double* const> pressure);

}  // namespace talus::depth
