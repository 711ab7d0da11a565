#pragma once
#include "domain/cell_table.hpp"
#include "domain/particles.hpp"
#include "domain/terrain.hpp"
#include "physics/depth/settings.hpp"
#include "physics/sph/passes.hpp"

/// The loops of the depth-integrated model, in the order of a step. M. Pastor et al., Int. J. Numer. Anal.
/// Methods Geomech. 33 (2009) 143; the varying smoothing length after M. Rodriguez-Paz, J. Bonet, Comput.
/// Struct. 83 (2005) 1396.
namespace talus::depth {

/// Heights of the columns, H_i = sum_j V_j W(r_ij, s_i), where s_i follows from how densely they stand,
/// sum_j W(r_ij, s_i) = (eta/s_i)^D: one step of Newton's method from the present smoothing length into
/// next_smoothing_length and column_height, which stays positive; grad_h_volume, P. F. Hopkins, Mon. Not. R.
/// Astron. Soc. 428 (2013) 2840, eq. 12; the divergence if the set has that field. Reads position, volume
/// (predicted_velocity) of partners.
void height_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings);

/// Moves the coefficients of earth pressure on by the strain of a time step. Reads divergence.
void strain_earth_pressure(ParticleSet& particles, const EarthPressure& law, double time_step);

/// What follows from a column and the bed under it: takes over next_smoothing_length, sets depth, wave_speed,
/// and pressure_factor, and those of bed_slope and apparent_gravity that the set has.
void meet_bed(ParticleSet& particles, const Terrain& terrain, const Settings& settings);

/// Acceleration by the pressure of the columns around, the force of the potential energy sum V (pressure
/// factor) H, and by an artificial viscosity between approaching ones; signal_speed. `count` as of the passes
/// of SPH. Reads position, volume, smoothing_length, predicted_velocity, depth, wave_speed, pressure_factor
/// and grad_h_volume of partners.
void pressure_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
                   sph::PassCount& count);

/// The mean velocity of the water around a column less that of the solid, and what drag moves from one to the
/// other in `time` [s]. Reads position, volume, smoothing_length, is_water, predicted_velocity of partners.
void relative_velocity_pass(ParticleSet& particles, const CellTable& table, Cells which,
                            const Settings& settings, double time);
/// Changes velocity by the drag between the phases; the sum of momenta stays. Reads position, volume,
/// smoothing_length, is_water, relative_velocity, exchange of partners.
void drag_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings);

/// What solid takes up of the ground in `time` [s]: volumes and velocities of columns of solid, and
/// released_water, which release_pass() gives to the columns of water around; the sum of momenta stays.
/// Hungr's law for both phases: of the ground's volume E_s |v_s| h time goes with an area of solid. Where no
/// water is around, ground that holds water stays. Reads position, volume, is_water of partners.
void erosion_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
                  double time);
/// Volumes and velocities of columns of water. Reads position, smoothing_length, is_water, released_water of
/// partners.
void release_pass(ParticleSet& particles, const CellTable& table, Cells which);

/// Adds gravity along the gradient of the free surface; for Gradient::level, whose pressure_factor is zero.
/// Reads position, volume, smoothing_length, depth, surface_level of partners.
void level_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings);

/// Completes the acceleration by gravity on the slope, by the metric of the bed's surface if the form is
/// fitted to it, and by the still_acceleration if the set has that.
void slide_on_bed(ParticleSet& particles, const Settings& settings);

}  // namespace talus::depth
