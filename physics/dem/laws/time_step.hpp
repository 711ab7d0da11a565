#pragma once

namespace talus::dem {

/// Time in which a Rayleigh wave crosses a grain, pi r sqrt(rho/G) / (0.1631 nu + 0.8766) [s]; the common
/// rule takes 0.1 to 0.3 of the least of all grains as the step. C. Thornton, C. W. Randall, in:
/// Micromechanics of Granular Materials (1988) 133; Y. Li, Y. Xu, C. Thornton, Powder Technol. 160 (2005)
/// 219.
double rayleigh_time(double radius, double density, double shear_modulus, double poisson_ratio);

/// Time that a collision of the linear spring lasts, pi / sqrt(k/m* - (gamma/2m*)^2) [s], where `damping` is
/// gamma/sqrt(k m*) [1]; without damping if that is supercritical.
double linear_collision_time(double stiffness, double effective_mass, double damping);

/// Time that an elastic collision after Hertz lasts, 2.9432 d_max/v, d_max = (15 m* v^2 / (16 E*
/// sqrt(R*)))^(2/5) [s]. K. L. Johnson, Contact Mechanics (1985), eqs 11.24-25.
double hertz_collision_time(double effective_modulus, double effective_radius, double effective_mass,
                            double impact_speed);

/// dF_n/dd = 2 E* sqrt(R* d) [N/m]; the tangential stiffness of Mindlin is 4 G*/E* times that.
double hertz_tangent_stiffness(double effective_modulus, double effective_radius, double overlap);

/// Greatest stable step of the leapfrog in packed grains whose every contact is a spring [s]: closest packing
/// of equal spheres, 12 contacts each, that move and turn, omega^2 = max(8 (1 + r), 40 r) k_n/m (the greatest
/// eigenvalue of the packing's dynamical matrix over all wave vectors; from r = 1/4 on it is that of all
/// grains turning alike). r = 2 k_t/k_n: tangential springs advance by velocities predicted to the end of
/// the step, and at the wall, where motion changes sign each step, such a spring acts twice as stiff.
/// Dashpots of ratio xi = gamma_n/(2 sqrt(k_n m*)), m* = m/2, and gamma_t = gamma_n sqrt(k_t/k_n) damp these
/// modes by as many contacts as springs act in: stable_step_of_mode().
double packed_lattice_limit(double mass, double normal_stiffness, double tangential_stiffness,
                            double damping_ratio);

/// Greatest stable step of grains that squeeze viscous films (Lubrication) [s]: velocities predicted to the
/// end of the step bear a damping rate below 1/dt, and a grain between two walls, each with the film at its
/// least gap, is damped at 2 gamma/m, gamma = 6 pi eta r^2 (1/roughness - 1/reach); closest packing of equal
/// grains has the same rate.
double squeezed_film_limit(double mass, double radius, double viscosity, double roughness, double reach);

/// Greatest stable step of a mode of frequency omega and damping rate c, x'' = -omega^2 x - c x', whose force
/// sees positions of the end of the step and velocities predicted to it [s]: at the wall motion changes sign
/// each step, the predicted velocity is twice that of the middle of the step, and 4 = (omega dt)^2 + 4 c dt.
/// `frequency2`: omega^2 [s-2], `damping_rate`: c [s-1]; infinite if both are 0.
double stable_step_of_mode(double frequency2, double damping_rate);

}  // namespace talus::dem
