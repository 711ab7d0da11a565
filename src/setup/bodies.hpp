#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "comm/communicator.hpp"
#include "domain/particles.hpp"
#include "physics/gravity/settings.hpp"
#include "physics/solid/material.hpp"
#include "physics/sph/settings.hpp"
#include "src/setup/density_profile.hpp"
#include "src/setup/packing.hpp"

namespace talus {

using gravity::newton_constant;

/// Added to the uniform velocity of a body at the start.
struct SineVelocity {
    Point amplitude;    ///< [m/s]
    Point wave_vector;  ///< [1/m]
    double phase;       ///< [rad]: v = amplitude sin(wave_vector . x + phase)
};
/// First bending mode of a thin cantilever, clamped at clamp, free at clamp + length along x, deflected along
/// y: v_y = tip_velocity f(x)/f(length). L. D. Landau, E. M. Lifshitz, Theory of Elasticity, section 25,
/// problem 5.
struct CantileverVelocity {
    double clamp, length;  ///< [m]
    double tip_velocity;   ///< [m/s]
};
/// v = rate (x - centre): uniform expansion, or along one axis only.
struct StretchVelocity {
    Point centre;  ///< [m]
    Point rate;    ///< [1/s] along each axis
};
/// Convergence on a centre, v = -speed (radius / r)^(D-1) along r; with radius = 0 the same speed everywhere.
struct RadialVelocity {
    Point centre;   ///< [m]
    double speed;   ///< inward [m/s]
    double radius;  ///< where it has that speed [m]
};
/// Square vortices of G. I. Taylor, A. E. Green, Proc. R. Soc. A 158 (1937) 499, in the plane of x and y:
/// speed (-cos kx sin ky, sin kx cos ky), k = 2 pi/length.
struct VortexVelocity {
    double speed;   ///< greatest [m/s]
    double length;  ///< of two vortices side by side [m]
};
/// Standing wave of small amplitude on water of even depth at the moment when its surface is level: H. Lamb,
/// Hydrodynamics, section 228. The vertical is the last axis.
struct StandingWaveVelocity {
    double speed;          ///< greatest, of the surface [m/s]
    double length;         ///< of the wave [m]
    double bottom, depth;  ///< [m]
};
using VelocityField = std::variant<std::monostate, SineVelocity, CantileverVelocity, StretchVelocity,
                                   RadialVelocity, VortexVelocity, StandingWaveVelocity>;

/// Stress at the start of matter that lies under a level surface.
struct GeostaticStart {
    Point up;              ///< unit vector against gravity
    double weight;         ///< density times gravity [N/m3]
    double surface;        ///< height of the surface along `up` [m]
    double lateral_ratio;  ///< K0, horizontal over vertical stress [1]
};

/// A body of a scene, before it is made of particles.
struct Body {
    std::string name;
    BodyShape shape;
    UnitCell cell;       ///< packing of the particles
    double spacing = 0;  ///< D-th root of the volume per particle [m]
    double jitter = 0;   ///< random displacement, largest, in spacings [1]
    Point velocity{};    ///< of the centre of mass [m/s]
    Point spin{};        ///< angular velocity about the centre of mass [rad/s]; in 2D its z component
    VelocityField velocity_field;
    DensityProfile profile = DensityProfile::even;  ///< of a sphere
    double density = 0;                             ///< mean [kg/m3]
    double internal_energy = 0;                     ///< where the density is the mean [J/kg]
    bool hydrostatic = false;                 ///< internal energy in proportion to the density, else even
    double damage = 0;                        ///< [1]
    std::optional<GeostaticStart> geostatic;  ///< none: free of stress
    std::vector<BodyShape> left_out;          ///< regions of the shape without particles
};

/// What the particles of a body add up to.
struct BodyCensus {
    std::uint64_t first_id = 0;
    std::uint64_t count = 0;     ///< particles
    double particle_volume = 0;  ///< [m3]
    double mass = 0;             ///< [kg]
    Point centre_of_mass{};      ///< [m]
};

/// Counts the particles that bodies become, and where they balance. Ids are given in order of bodies and
/// points of their packing, so that they, and what is drawn at random by them, depend on the scene alone.
/// Equal on every rank.
std::vector<BodyCensus> take_census(const std::vector<Body>& bodies, int dimension, std::uint64_t seed);

/// Makes the particles of all bodies, each rank its share, with the state at time 0. Collective.
ParticleSet make_particles(const Communicator& comm, const std::vector<Body>& bodies,
                           const std::vector<Material>& materials, const ParticleSet& prototype,
                           const sph::Settings& settings, std::uint64_t seed);

/// Velocity of the body's matter at `x` at time 0 [m/s].
Point velocity_at(const Body& body, const Point& x, const Point& centre_of_mass, int dimension);

/// Whether a particle of one of the bodies lies inside the other.
bool overlap(const Body& a, const Body& b, int dimension);

/// Spin [rad/s] beyond which a sphere of that density loses its equator: omega^2 = 4/3 pi G rho.
double break_up_spin(double density, double gravitational_constant = newton_constant);
/// [s] of a spin [rad/s].
double rotation_period(double spin);

}  // namespace talus
