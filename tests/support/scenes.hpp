#pragma once
#include <string>

#include "src/simulation.hpp"

/// Small simulations of every kind, built without files, for tests that compare bits.
namespace talus::test {

struct SmallScene {
    std::string name;
    Setup setup;
    ParticleSet particles;  ///< all of them
};

SmallScene rock_impact_2d();        ///< Godunov, strength, fracture, two bodies, open box
SmallScene periodic_gas_3d();       ///< standard SPH, Wendland C2, variable h, periodic box
SmallScene gas_between_walls_2d();  ///< Godunov, variable h, reflecting x, periodic y
SmallScene collapsing_gas_3d();     ///< self-gravity, standard SPH, variable h, far particles, open box
SmallScene standing_wave_1d();      ///< Godunov with quintic interpolation, periodic
SmallScene
soil_on_walls_2d();  ///< softening and dilating soil, gravity, a wall that swings and one that slips

}  // namespace talus::test
