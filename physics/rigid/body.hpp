#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "domain/particles.hpp"
#include "domain/rigid_fields.hpp"
#include "physics/dem/clumps/clump_motion.hpp"

namespace talus::rigid {

using dem::Vector3;

/// What a rigid body touches others with.
struct ContactSphere {
    Vector3<> place;   ///< from the centre of mass, along the principal axes [m]
    double radius;     ///< [m]
    std::uint64_t id;  ///< of a particle of the body
};

/// A body of particles that moves as one. In 2D it is 1 m deep and turns about z.
struct Body {
    std::string name;
    std::uint8_t index = 0;  ///< among the bodies of the scene
    double mass = 0;         ///< [kg]
    Vector3<> force;         ///< on it besides those of water, gravity and contacts [N]
    Vector3<> inertia;       ///< principal moments [kg m2]
    double area = 0;         ///< of its surface [m2]
    std::uint64_t first_id = 0;

    std::vector<ContactSphere> spheres;  ///< none: it passes through others
    std::uint8_t material = 0;           ///< of its contacts
    double bounding_radius = 0;          ///< of the spheres about the centre of mass [m]
    Vector3<> lower, upper;              ///< corners of their centres, along the principal axes [m]
};

/// Where a body is, how it moves, and by what it is driven between two evaluations.
struct State : dem::ClumpState {
    Vector3<> acceleration;  ///< by water and gravity [m/s2]
    Vector3<> torque;        ///< by water, about the centre of mass [N m]
};

/// Changes velocity and angular momentum by those forces over a time.
void kick(State& state, double time);
/// Moves and turns without forces, the turn exact about each principal axis (dem::turned_freely).
void drift(const Body& body, State& state, double time);

/// [rad/s]
Vector3<> angular_velocity(const Body& body, const State& state);
/// Kinetic [J].
double kinetic_energy(const Body& body, const State& state);

/// Brings own particles of bodies to their places in them and gives them their velocity; one state a body.
void place_particles(ParticleSet& particles, std::span<const Body> bodies, std::span<const State> states);

/// Calls visit(i, k, arm) for own particles of bodies: particle, body, and where it is from the body's centre
/// of mass [m].
template <class Visit>
void for_each_particle(const ParticleSet& particles, std::span<const Body> bodies,
                       std::span<const State> states, Visit&& visit) {
    constexpr std::size_t none = ~std::size_t{0};
    std::array<std::size_t, 256> body_of{};
    body_of.fill(none);
    std::vector<dem::RotationMatrix> axes;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        body_of[bodies[k].index] = k;
        axes.emplace_back(states[k].orientation);
    }
    const bool flat = particles.dimension() == 2;
    const std::uint8_t* index = particles.data(field::body);
    const double *x = particles.data(field::place_in_body, 0), *y = particles.data(field::place_in_body, 1),
                 *z = particles.data(field::place_in_body, flat ? 1 : 2);
    for (std::size_t i = 0; i < particles.size(); ++i)
        if (const std::size_t k = body_of[index[i]]; k != none)
            visit(i, k, axes[k].turned({x[i], y[i], flat ? 0.0 : z[i]}));
}

}  // namespace talus::rigid
