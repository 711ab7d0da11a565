#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/dem/laws/contact_law.hpp"
#include "physics/dem/laws/materials.hpp"

namespace talus::dem {

/// An elasticity with friction and nothing else.
template <class Elasticity, class Real = double>
using WithFriction = ContactLaw<Real, Elasticity, CoulombFriction<Real>, RollsFreely<Real>,
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

inline Ball make_ball(double radius, double density) {
    Ball ball;
    ball.radius = radius;
    ball.mass = 4 * std::numbers::pi / 3 * radius * radius * radius * density;
    return ball;
}

/// Pair of equal surfaces, or of one and a rigid one.
inline PairProperties equal_pair(double youngs_modulus, double poisson_ratio, double restitution,
                                 double friction) {
    const MaterialPairs pairs({{.name = "both",
                                .youngs_modulus = youngs_modulus,
                                .poisson_ratio = poisson_ratio,
                                .restitution = restitution,
                                .friction = friction}});
    return pairs(0, 0);
}
inline PairProperties with_rigid_plane(double youngs_modulus, double poisson_ratio, double restitution,
                                       double friction) {
    PairProperties pair = equal_pair(youngs_modulus, poisson_ratio, restitution, friction);
    pair.effective_modulus *= 2;
    pair.effective_shear_modulus *= 2;
    return pair;
}

/// Ball on the half space z < 0 at rest, with a constant force per mass. Leapfrog, forces from the velocities
/// of the middle of the step.
template <class Law>
struct BallOnPlane {
    Law law;
    Ball ball;
    Vector3<double> gravity{};
    typename Law::History history{};
    ContactLoad<double> load{};
    Vector3<double> torque{};
    double overlap = 0;

    void step(double dt) {
        ball.kick(load.force + ball.mass * gravity, torque, dt / 2);
        ball.drift(dt);
        overlap = ball.radius - ball.position.z;
        const auto k = wall_kinematics<double>({0, 0, 1}, overlap, ball, {}, {}, dt);
        load = law(k, history);
        torque = torque_about_centre(k.normal, contact_arm(ball.radius, overlap), load);
        ball.kick(load.force + ball.mass * gravity, torque, dt / 2);
    }
};

/// Two balls, likewise.
template <class Law>
struct TwoBalls {
    Law law;
    Ball first, second;
    typename Law::History history{};
    ContactLoad<double> load{};
    Vector3<double> torque_1{}, torque_2{};
    double overlap = 0;

    void step(double dt) {
        kick(dt);
        first.drift(dt);
        second.drift(dt);
        const Vector3<double> separation = first.position - second.position;
        const auto k = grain_kinematics<double>(separation, norm(separation), first, second, dt);
        overlap = k.overlap;
        load = law(k, history);
        torque_1 = torque_about_centre(k.normal, contact_arm(first.radius, overlap), load);
        torque_2 = torque_about_centre<double>(-k.normal, contact_arm(second.radius, overlap),
                                               {-load.force, -load.couple});
        kick(dt);
    }
    void kick(double dt) {
        first.kick(load.force, torque_1, dt / 2);
        second.kick(-load.force, torque_2, dt / 2);
    }
};

/// What was seen of a collision, and what is left of it.
template <class System>
struct Collision {
    System after;
    double greatest_overlap = 0, greatest_force = 0;  ///< [m], [N]
    double duration = 0;                              ///< time of contact [s]
    double greatest_energy = 0;                       ///< kinetic, at any time [J]
    bool ended = false;
};

template <class Law>
double kinetic_energy(const BallOnPlane<Law>& s) {
    return s.ball.kinetic_energy();
}
template <class Law>
double kinetic_energy(const TwoBalls<Law>& s) {
    return s.first.kinetic_energy() + s.second.kinetic_energy();
}
template <class Law>
double effective_radius(const BallOnPlane<Law>& s) {
    return s.ball.radius;
}
template <class Law>
double effective_radius(const TwoBalls<Law>& s) {
    return s.first.radius * s.second.radius / (s.first.radius + s.second.radius);
}

/// From the first touch until they part, at most 1e6 steps.
template <class System>
Collision<System> collide(const System& before, double dt) {
    Collision<System> c{.after = before};
    System& s = c.after;
    const double reach = s.law.reach(effective_radius(s));
    bool touched = false;
    for (int step = 0; step < 1000000 && !c.ended; ++step) {
        s.step(dt);
        c.greatest_overlap = std::max(c.greatest_overlap, s.overlap);
        c.greatest_force = std::max(c.greatest_force, norm(s.load.force));
        c.greatest_energy = std::max(c.greatest_energy, kinetic_energy(s));
        if (s.overlap > 0) c.duration += dt;
        touched = touched || s.overlap > 0;
        c.ended = touched && s.overlap < -reach;
    }
    return c;
}

}  // namespace talus::dem
