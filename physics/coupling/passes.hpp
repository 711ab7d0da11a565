#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "domain/cell_table.hpp"
#include "domain/particles.hpp"
#include "physics/coupling/averaging.hpp"
#include "physics/dem/vector3.hpp"

namespace talus::coupling {

/// How grains are spread over the fluid particles around them. The weight of a pair of grain i and fluid
/// particle a is w_ia = w(|x_i - x_a|) with those of the images of i behind walls. Fluid particles count with
/// their volumes V_a, and S_i = sum_a V_a w_ia is 1 far within even fluid. Of what is exchanged by grain i, a
/// has the share V_a w_ia/S_i: the same to gather what the fluid does to the grain and to spread what the
/// grain does to the fluid.
struct Spreading {
    enum class Shape : std::uint8_t { wendland, mollifier };
    Shape shape = Shape::wendland;
    double radius = 0;  ///< beyond which no weight is [m]
    /// Share of the room around a grain that fluid fills, from which on the grain counts wholly; of less, in
    /// proportion. At a flat free surface half is filled.
    double full = 0.85;
    /// Walls behind which grains have images; no fluid particle that counts is behind one.
    std::vector<MirrorPlane> planes = {};

    double wet_share(double filled) const { return std::min(filled / full, 1.0); }
};

/// Grains and fluid on one grid, both with copies of all that is within Spreading::radius of own particles.
/// Sums are in canonical order: the same bits on any number of ranks.
struct Mixture {
    ParticleSet& grains;  ///< with position, radius and kernel_sum
    const CellTable& grain_cells;
    ParticleSet& fluid;  ///< with position and quadrature_volume
    const CellTable& fluid_cells;
    int reach;  ///< in cells, of Spreading::radius
};

/// kernel_sum and wet_share of the own grains. Reads quadrature_volume and position of the fluid. The room
/// that is filled is the fluid's share of what walls leave, or that with images if it is more: no wall is a
/// dry place. This and what follows return how many pairs of a grain or an image and a fluid particle they
/// weighed.
std::uint64_t sum_weights(const Mixture& mixture, const Spreading& spreading);

/// Which solid fraction is meant: `normalised`: sum_i V_i w_ia/S_i, whose integral is the volume of the
/// grains on any particles. `raw`: sum_i V_i w_ia without images, whose integral is that in the limit of fine
/// particles far from walls.
enum class VolumeFraction : std::uint8_t { normalised, raw };

/// The solid fraction of the own fluid particles, into `fraction`. Reads position, radius, kernel_sum of
/// grains.
std::uint64_t spread_volume(const Mixture& mixture, const Spreading& spreading, VolumeFraction kind,
                            const Field<double>& fraction);

/// What the fluid is around a grain, averages with its shares.
struct Gathered {
    dem::Vector3<> velocity;   ///< [m/s]
    dem::Vector3<> vorticity;  ///< [1/s]
    /// Of pressure and viscosity on the fluid, for each volume of space, -grad p + div tau [N/m3].
    dem::Vector3<> force_density;
    dem::Vector3<> acceleration;  ///< of the fluid by pressure, viscosity and gravity [m/s2]
    dem::Vector3<> reaction;      ///< of the fluid by grains [m/s2]
    double solid_fraction;        ///< [1]
    double density;               ///< of mass in space, rho epsilon [kg/m3]
    double crowding;  ///< mean of the shared fraction over that density: grains' volume for each mass of
                      ///< the fluid [m3/kg]
};

/// For each own grain; zeros where no fluid is. Reads quadrature_volume, mass, predicted_velocity,
/// solid_fraction, `shared_fraction` (of the normalised kind), pair_acceleration and grain_acceleration of
/// the fluid. The vorticity, of the velocities' best linear fit, only if it is asked for.
std::uint64_t gather(const Mixture& mixture, const Spreading& spreading, const Field<double>& shared_fraction,
                     bool vorticity, std::span<Gathered> gathered);

/// grain_acceleration of the own fluid particles: what balances exchanged_force. Reads position, kernel_sum
/// and exchanged_force of the grains.
std::uint64_t spread_force(const Mixture& mixture, const Spreading& spreading);

}  // namespace talus::coupling
