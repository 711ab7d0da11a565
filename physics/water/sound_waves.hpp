#pragma once
#include <array>

#include "physics/water/settings.hpp"

/// How waves of still water on a square or cubic lattice grow or decay in steps of WaterSimulation, by linear
/// theory: docs/charts.md, "stability".
namespace talus::water {

/// Rates that the lattice sums of a plane wave give [1/s].
struct WaveRates {
    double sound;      ///< angular frequency
    double diffusion;  ///< decay of the density
    double viscosity;  ///< decay of the velocity by laminar viscosity
};

/// Of the wave vector `wave` [1/m]; `settings.radius_in_spacings` gives the lattice. `dimension` 2 or 3.
WaveRates wave_rates(const Settings& settings, int dimension, const std::array<double, 3>& wave);

/// Factor by which a sound wave, or a shear wave if slower to decay, grows in a step [1]. A step takes what
/// changes velocity and density from states predicted by what did so in the step before: for a rate q =
/// lambda dt its factors z obey z^2 - (1 + 3q/2) z + q/2 = 0, as those of the second method of Adams and
/// Bashforth do. Sound alone, q = i omega dt, grows by about (omega dt)^4/4 each step however short it is;
/// friction alone, q = -x, bears x = 1.
double growth(const WaveRates& rates, double time_step);

struct GrowingWave {
    std::array<double, 3> wave{};  ///< wave vector [1/m]
    double growth = 0;             ///< factor of a step [1]
};
/// The wave that grows fastest, of those that twelve spacings bear.
GrowingWave fastest_growing(const Settings& settings, int dimension, double time_step);

/// Greatest Courant number that no wave grows with, to a millionth each step. No more than `most`.
double greatest_courant(Settings settings, int dimension, double most);

}  // namespace talus::water
