#pragma once

namespace talus::reference {

/// A flow at a place and time.
struct ShallowState {
    double depth, velocity;  ///< [m], [m/s]
};

/// A dam at x = 0 vanishes at time 0: water of one depth to the left, none or less to the right, on a level
/// bed. A. Ritter, Z. Ver. Dtsch. Ing. 36 (1892) 947; J. J. Stoker, Water Waves (1957), section 10.8.
class DamBreak {
  public:
    DamBreak(double upstream, double downstream, double gravity);
    ShallowState at(double x, double time) const;
    /// Behind the bore; zero depth if the bed is dry.
    ShallowState middle() const { return middle_; }
    double bore_speed() const { return bore_speed_; }

  private:
    double upstream_, downstream_, gravity_, bore_speed_ = 0;
    ShallowState middle_{};
};

/// The same on a dry plane, along its slope, with depths along its normal and Coulomb friction that it
/// overcomes: A. Mangeney, P. Heinrich, R. Roche, Pure Appl. Geophys. 157 (2000) 1081.
struct InclinedDamBreak {
    double depth;         ///< upstream [m]
    double gravity;       ///< along the normal [m/s2]
    double acceleration;  ///< gravity along the slope less friction [m/s2]
    ShallowState at(double s, double time) const;
};

}  // namespace talus::reference
