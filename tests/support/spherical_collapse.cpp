#include "tests/support/spherical_collapse.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace talus::reference {

namespace {

constexpr double gamma = 5.0 / 3, first_energy = 0.05;
constexpr double quadratic_viscosity = 2, linear_viscosity = 0.2, courant = 0.2;

double volume_within(double radius) { return 4.0 / 3 * std::numbers::pi * radius * radius * radius; }

}  // namespace

SphericalCollapse::SphericalCollapse(std::size_t shells)
    : radius_(shells + 1),
      velocity_(shells + 1, 0),
      mass_within_(shells + 1),
      mass_(shells),
      energy_(shells, first_energy),
      density_(shells),
      pressure_(shells),
      viscous_(shells, 0) {
    for (std::size_t i = 0; i <= shells; ++i) {
        const double s = static_cast<double>(i) / static_cast<double>(shells);
        radius_[i] = s * std::sqrt(3 - 2 * s);  // thin also at the surface, where the shock is strongest
        mass_within_[i] = radius_[i] * radius_[i];
    }
    for (std::size_t j = 0; j < shells; ++j) {
        mass_[j] = mass_within_[j + 1] - mass_within_[j];
        density_[j] = mass_[j] / (volume_within(radius_[j + 1]) - volume_within(radius_[j]));
        pressure_[j] = (gamma - 1) * density_[j] * energy_[j];
    }
}

double SphericalCollapse::step_limit() const {
    double least = 0.01;
    for (std::size_t j = 0; j < mass_.size(); ++j) {
        const double sound = std::sqrt(gamma * (pressure_[j] + viscous_[j]) / density_[j]);
        const double closing = std::abs(velocity_[j + 1] - velocity_[j]);
        least = std::min(
            least, courant * (radius_[j + 1] - radius_[j]) / (sound + 2 * quadratic_viscosity * closing));
    }
    return least;
}

/// Velocities over `time_step`. Half a shell of mass lies on either side of a face, nothing outside the last.
void SphericalCollapse::accelerate(double time_step) {
    const std::size_t last = mass_.size();
    for (std::size_t i = 1; i <= last; ++i) {
        const double inside = pressure_[i - 1] + viscous_[i - 1];
        const double outside = i < last ? pressure_[i] + viscous_[i] : 0;
        const double mass = 0.5 * (mass_[i - 1] + (i < last ? mass_[i] : 0));
        const double area = 4 * std::numbers::pi * radius_[i] * radius_[i];
        velocity_[i] +=
            time_step * (area * (inside - outside) / mass - mass_within_[i] / (radius_[i] * radius_[i]));
    }
}

/// Radii, densities and, by the work of the mean pressure, energies over `time_step`.
void SphericalCollapse::move(double time_step) {
    for (std::size_t i = 1; i < radius_.size(); ++i) radius_[i] += time_step * velocity_[i];
    for (std::size_t j = 0; j < mass_.size(); ++j) {
        const double density = mass_[j] / (volume_within(radius_[j + 1]) - volume_within(radius_[j]));
        const double growth = 1 / density - 1 / density_[j];  // of the specific volume
        const double closing = std::max(velocity_[j] - velocity_[j + 1], 0.0);
        const double sound = std::sqrt(gamma * pressure_[j] / density_[j]);
        viscous_[j] = 0.5 * (density + density_[j]) * closing *
                      (quadratic_viscosity * closing + linear_viscosity * sound);
        energy_[j] = (energy_[j] - growth * (0.5 * pressure_[j] + viscous_[j])) /
                     (1 + 0.5 * (gamma - 1) * density * growth);
        density_[j] = density;
        pressure_[j] = (gamma - 1) * density * energy_[j];
    }
}

void SphericalCollapse::run_to(double time) {
    while (time_ < time) {
        const double step = std::min({step_limit(), last_step_ > 0 ? 1.1 * last_step_ : 1e-5, time - time_});
        accelerate(0.5 * (last_step_ + step));
        move(step);
        time_ += step;
        last_step_ = step;
    }
}

BallEnergies SphericalCollapse::energies() const {
    BallEnergies sum{.time = time_, .kinetic = 0, .thermal = 0, .potential = 0};
    for (std::size_t j = 0; j < mass_.size(); ++j) {
        sum.thermal += mass_[j] * energy_[j];
        for (const std::size_t i : {j, j + 1}) {
            if (i == 0) continue;
            sum.kinetic += 0.25 * mass_[j] * velocity_[i] * velocity_[i];
            sum.potential -= 0.5 * mass_[j] * mass_within_[i] / radius_[i];
        }
    }
    return sum;
}

}  // namespace talus::reference
