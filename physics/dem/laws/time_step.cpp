#include "physics/dem/laws/time_step.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace talus::dem {

double rayleigh_time(double radius, double density, double shear_modulus, double poisson_ratio) {
    return std::numbers::pi * radius * std::sqrt(density / shear_modulus) / (0.1631 * poisson_ratio + 0.8766);
}

double linear_collision_time(double stiffness, double effective_mass, double damping) {
    const double share = 0.25 * damping * damping, frequency = std::sqrt(stiffness / effective_mass);
    return std::numbers::pi / (share < 1 ? frequency * std::sqrt(1 - share) : frequency);
}

double hertz_collision_time(double effective_modulus, double effective_radius, double effective_mass,
                            double impact_speed) {
    const double d = std::pow(15 * effective_mass * impact_speed * impact_speed /
                                  (16 * effective_modulus * std::sqrt(effective_radius)),
                              0.4);
    return 2.943275 * d / impact_speed;
}

double hertz_tangent_stiffness(double effective_modulus, double effective_radius, double overlap) {
    return 2 * effective_modulus * std::sqrt(effective_radius * overlap);
}

double packed_lattice_limit(double mass, double normal_stiffness, double tangential_stiffness,
                            double damping_ratio) {
    const double ratio = 2 * tangential_stiffness / normal_stiffness;
    const double frequency2 = normal_stiffness / mass;                 // of one contact
    const double damping = damping_ratio * std::sqrt(2 * frequency2),  // gamma_n/m, and gamma_t/m
        across = damping * std::sqrt(tangential_stiffness / normal_stiffness);
    return std::min(stable_step_of_mode(8 * (1 + ratio) * frequency2, 8 * (damping + across)),
                    stable_step_of_mode(40 * ratio * frequency2, 40 * across));
}

double stable_step_of_mode(double frequency2, double damping_rate) {
    return 2 / (damping_rate + std::sqrt(damping_rate * damping_rate + frequency2));
}

double squeezed_film_limit(double mass, double radius, double viscosity, double roughness, double reach) {
    const double damping = 6 * std::numbers::pi * viscosity * radius * radius * (1 / roughness - 1 / reach);
    return mass / (2 * damping);
}

}  // namespace talus::dem
