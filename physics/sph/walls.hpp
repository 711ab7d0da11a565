#pragma once
#include <array>
#include <span>

#include "domain/cell_table.hpp"
#include "domain/particles.hpp"
#include "physics/dem/walls/motion.hpp"
#include "physics/sph/settings.hpp"

namespace talus::sph {

enum class WallSlip : std::uint8_t { no_slip, free_slip };

/// A body whose particles are a wall: they move as prescribed, and carry what the matter in front of them
/// has.
struct Wall {
    WallSlip slip = WallSlip::no_slip;
    dem::Vector3<> normal;  ///< unit vector towards the matter, of a wall that slips
    dem::WallMotion motion;
};

/// A wall at one time.
struct WallNow {
    bool is_wall = false;  ///< false: a body of matter
    bool slips = false;
    bool moves_freely = false;  ///< its particles have velocities of their own, not those of the pose
    dem::Vector3<> normal;
    dem::WallPose pose;
    dem::Vector3<> weight;  ///< gravity less the acceleration of the wall [m/s2]
};

/// The wall at `time` [s] under gravity [m/s2].
WallNow at_time(const Wall& wall, double time, const dem::Vector3<>& gravity);

/// Extrapolates pressure, density, deviatoric stress and velocity of the matter within range of the forces
/// into the own wall particles, so that sums over them are complete: p_w = sum (p_j + rho_j (g - a_w).(x_w -
/// x_j)) W / sum W, no less than zero; velocity mirrored about the wall's, all of it (no slip) or along the
/// normal (free slip); shear along a wall that slips changes sign. S. Adami, X. Y. Hu, N. A. Adams, J.
/// Comput. Phys. 231 (2012) 7057, eqs 22-27; stress as in H. H. Bui, R. Fukagawa, K. Sako, S. Ohno, Int. J.
/// Numer. Anal. Methods Geomech. 32 (2008) 1537. `walls`: one a body. Reads position, body, smoothing_length,
/// predicted_velocity, predicted_density, pressure, predicted_stress of partners; writes predicted_velocity,
/// predicted_density, pressure and predicted_stress of wall particles, which no one reads here.
void wall_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
               std::span<const WallNow> walls);

/// Gives wall particles the velocity of their wall, but not where it moves freely; nothing if `walls` is
/// empty.
void move_walls(ParticleSet& particles, std::span<const WallNow> walls);

/// The same after an evaluation, and takes the rates from them: walls feel no forces and do not age.
void keep_walls(ParticleSet& particles, std::span<const WallNow> walls);

}  // namespace talus::sph
