#include "physics/rigid/body.hpp"

namespace talus::rigid {

void kick(State& state, double time) {
    state.velocity += time * state.acceleration;
    state.angular_momentum += time * state.torque;
}

void drift(const Body& body, State& state, double time) {
    state.centre += time * state.velocity;
    state.orientation = dem::turned_freely(state.orientation, state.angular_momentum, body.inertia, time);
}

Vector3<> angular_velocity(const Body& body, const State& state) {
    return dem::angular_velocity(state.angular_momentum, body.inertia,
                                 dem::RotationMatrix(state.orientation));
}

double kinetic_energy(const Body& body, const State& state) {
    return 0.5 * (body.mass * dot(state.velocity, state.velocity) +
                  dot(state.angular_momentum, angular_velocity(body, state)));
}

void place_particles(ParticleSet& particles, std::span<const Body> bodies, std::span<const State> states) {
    std::vector<Vector3<>> turning;
    for (std::size_t k = 0; k < bodies.size(); ++k) turning.push_back(angular_velocity(bodies[k], states[k]));
    const int dimension = particles.dimension();
    std::array<double*, 3> x{}, v{};
    for (int a = 0; a < dimension; ++a) {
        x[static_cast<std::size_t>(a)] = particles.data(field::position, a);
        v[static_cast<std::size_t>(a)] = particles.data(field::velocity, a);
    }
    for_each_particle(particles, bodies, states, [&](std::size_t i, std::size_t k, const Vector3<>& arm) {
        const Vector3<> place = states[k].centre + arm, moves = states[k].velocity + cross(turning[k], arm);
        const std::array<double, 3> to{place.x, place.y, place.z}, velocity{moves.x, moves.y, moves.z};
        for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
            x[a][i] = to[a];
            v[a][i] = velocity[a];
        }
    });
}

}  // namespace talus::rigid
