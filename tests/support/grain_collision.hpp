#pragma once
#include <algorithm>
#include <cmath>

#include "physics/dem/laws/contact_law.hpp"

namespace talus::dem {

/// Hertz and Mindlin with friction and nothing else.
template <class Real>
using HertzFriction = ContactLaw<Real, HertzMindlin<Real>, CoulombFriction<Real>, RollsFreely<Real>,
                                 TwistsFreely<Real>, NoSurfaceForce<Real>>;
template <class Real>
using LinearFriction = ContactLaw<Real, LinearSpring<Real>, CoulombFriction<Real>, RollsFreely<Real>,
                                  TwistsFreely<Real>, NoSurfaceForce<Real>>;

/// A homogeneous ball that moves freely.
struct Ball : Grain<double> {
    Vector3<double> position;

    double inertia() const { return 0.4 * mass * radius * radius; }
    double kinetic_energy() const {
        return 0.5 * mass * dot(velocity, velocity) +
               0.5 * inertia() * dot(angular_velocity, angular_velocity);
    }
    void kick(const Vector3<double>& force, const Vector3<double>& torque, double dt) {
        velocity += (dt / mass) * force;
        angular_velocity += (dt / inertia()) * torque;
    }
    void drift(double dt) { position += dt * velocity; }
};

/// What is left of a collision, and what was seen of it.
struct Collision {
    Ball first, second;
    double greatest_overlap = 0, greatest_force = 0;  ///< [m], [N]
    double duration = 0;                              ///< time of contact [s]
    double greatest_energy = 0;                       ///< kinetic, at any time [J]
    bool ended = false;
};

/// A ball meets the half space z < 0 at rest.
template <class Law>
Collision hit_plane(const Law& law, Ball ball, double dt, int most_steps = 1000000) {
    Collision c{.first = ball, .second = {}};
    typename Law::History history{};
    ContactLoad<double> load{};
    Vector3<double> torque{};
    for (int step = 0; step < most_steps; ++step) {
        Ball& b = c.first;
        b.kick(load.force, torque, dt / 2);
        b.drift(dt);
        const auto k = wall_kinematics<double>({0, 0, 1}, b.radius - b.position.z, b, {}, {}, dt);
        load = law(k, history);
        torque = torque_about_centre(k.normal, contact_arm(b.radius, k.overlap), load);
        b.kick(load.force, torque, dt / 2);
        c.greatest_overlap = std::max(c.greatest_overlap, k.overlap);
        c.greatest_force = std::max(c.greatest_force, load.force.z);
        c.greatest_energy = std::max(c.greatest_energy, b.kinetic_energy());
        if (k.overlap > 0) c.duration += dt;
        if (k.overlap < -law.reach(c.first.radius) && b.velocity.z > 0) {
            c.ended = true;
            break;
        }
    }
    return c;
}

/// Two balls.
template <class Law>
Collision collide(const Law& law, const Ball& first, const Ball& second, double dt,
                  int most_steps = 1000000) {
    Collision c{.first = first, .second = second};
    typename Law::History history{};
    ContactLoad<double> load{};
    Vector3<double> torque_1{}, torque_2{};
    const auto kick = [&] {
        c.first.kick(load.force, torque_1, dt / 2);
        c.second.kick(-load.force, torque_2, dt / 2);
    };
    for (int step = 0; step < most_steps; ++step) {
        kick();
        c.first.drift(dt);
        c.second.drift(dt);
        const Vector3<double> separation = c.first.position - c.second.position;
        const auto k = grain_kinematics(separation, norm(separation), Grain<double>(c.first),
                                        Grain<double>(c.second), dt);
        load = law(k, history);
        torque_1 = torque_about_centre(k.normal, contact_arm(c.first.radius, k.overlap), load);
        torque_2 = torque_about_centre(-k.normal, contact_arm(c.second.radius, k.overlap),
                                       {-load.force, -load.couple});
        kick();
        c.greatest_overlap = std::max(c.greatest_overlap, k.overlap);
        c.greatest_force = std::max(c.greatest_force, norm(load.force));
        c.greatest_energy = std::max(c.greatest_energy, c.first.kinetic_energy() + c.second.kinetic_energy());
        if (k.overlap > 0) c.duration += dt;
        if (k.overlap < -law.reach(c.first.radius) &&
            dot(c.first.velocity - c.second.velocity, separation) > 0) {
            c.ended = true;
            break;
        }
    }
    return c;
}

}  // namespace talus::dem
