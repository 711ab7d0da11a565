#pragma once

namespace talus::reference {

struct GasState {
    double density;   ///< [kg/m3]
    double velocity;  ///< [m/s]
    double pressure;  ///< [Pa]
};

/// Speeds of the waves that leave the diaphragm [m/s]. A shock has head = tail.
struct WaveSpeeds {
    double left_head, left_tail;
    double contact;
    double right_tail, right_head;
};

/// Exact solution of the Riemann problem of an ideal gas.
/// E. F. Toro, Riemann Solvers and Numerical Methods for Fluid Dynamics, 3rd ed., Springer 2009, ch. 4.
class ExactRiemann {
  public:
    /// Throws std::invalid_argument for states that are not gas or that tear a vacuum open (eq. 4.40).
    ExactRiemann(GasState left, GasState right, double gamma);

    double star_pressure() const { return star_pressure_; }  ///< between the two outer waves [Pa]
    double star_velocity() const { return star_velocity_; }  ///< of the contact [m/s]
    double star_density_left() const { return star_density(left_); }
    double star_density_right() const { return star_density(right_); }
    WaveSpeeds wave_speeds() const;

    /// State on the ray x / t = `speed` [m/s]; on the contact itself, the right one.
    GasState sample(double speed) const;

  private:
    double sound_speed(const GasState& state) const;
    double velocity_change(const GasState& side, double pressure) const;
    double velocity_change_slope(const GasState& side, double pressure) const;
    double star_density(const GasState& side) const;

    GasState left_, right_;
    double gamma_;
    double star_pressure_ = 0, star_velocity_ = 0;
};

}  // namespace talus::reference
