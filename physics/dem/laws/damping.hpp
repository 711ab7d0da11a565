#pragma once
#include <cstdint>

namespace talus::dem {

/// What a damped normal force does at the end of a collision, when its damping exceeds its elastic part.
enum class EndOfContact : std::uint8_t {
    may_attract,  ///< the force is taken as it is, the pair is held back for a moment
    cut_at_zero   ///< no normal force below zero
};

/// Without attraction no finite damping takes all of the speed.
inline constexpr double least_restitution_cut = 0.01;

// Damping gamma_n / sqrt(k_n m*) that gives a coefficient of restitution e, the same at every speed of
// impact. They differ: damping meant for forces that may attract gives with forces cut at zero a greater
// restitution than asked for. Both throw std::invalid_argument for a restitution outside [0, 1].

/// For F = k_n d + gamma_n d'. May attract: 2 B(e), B = -ln e / sqrt(ln^2 e + pi^2), 2 at e = 0. Cut at zero:
/// T. Schwager, T. Poeschel, Granular Matter 9 (2007) 465, eqs 17-20, solved for the damping; e >=
/// least_restitution_cut.
double linear_damping(double restitution, EndOfContact end);

/// For F = k_n d + gamma_n d' with k_n ~ sqrt(d). May attract: sqrt(5) B(e), sqrt(5) at e = 0. Cut at zero:
/// the collision is integrated and the damping found that makes it end as asked for, e >=
/// least_restitution_cut; the fit of C. Thornton, S. J. Cummins, P. W. Cleary, Powder Technol. 233 (2013) 30
/// agrees within its own accuracy.
double hertz_damping(double restitution, EndOfContact end);

}  // namespace talus::dem
