#pragma once
#include <cstddef>
#include <vector>

namespace talus::reference {

/// Energies of a ball of gas. Units: G, mass and first radius are 1.
struct BallEnergies {
    double time, kinetic, thermal, potential;
    double total() const { return kinetic + thermal + potential; }
};

/// Collapse of a cold ball of gas, rho = 1/(2 pi r), u = 0.05, gamma = 5/3, in spherical symmetry: Lagrangian
/// shells, velocities between them, artificial viscosity in compression. A. E. Evrard, MNRAS 235 (1988) 911;
/// J. von Neumann, R. D. Richtmyer, J. Appl. Phys. 21 (1950) 232; R. D. Richtmyer, K. W. Morton, Difference
/// Methods for Initial-Value Problems, 2nd ed. (1967), section 12.
class SphericalCollapse {
  public:
    /// `shells`: their number; thinner ones at the centre and the surface.
    explicit SphericalCollapse(std::size_t shells);

    /// Goes on to a time not before the present one.
    void run_to(double time);
    BallEnergies energies() const;

  private:
    double step_limit() const;
    void accelerate(double time_step);
    void move(double time_step);

    std::vector<double> radius_, velocity_, mass_within_;               // of the faces, the centre first
    std::vector<double> mass_, energy_, density_, pressure_, viscous_;  // of the shells
    double time_ = 0, last_step_ = 0;
};

}  // namespace talus::reference
