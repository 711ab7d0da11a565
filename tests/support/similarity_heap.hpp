#pragma once

namespace talus::reference {

/// A parabolic heap on a rough plane, h = H/(f g) (1 - (s - s_c)^2/(L g)^2 - y^2/(L f)^2) with s down the
/// slope: its centre slides as a block, its extents g and f obey ordinary differential equations. In one
/// dimension (f = 1) this is exact while all moves down the slope; in two friction across the slope is taken
/// to be in proportion to the velocity across over that of the centre. S. B. Savage, K. Hutter, J. Fluid
/// Mech. 199 (1989) 177; K. Hutter, M. Siegel, S. B. Savage, Y. Nohguchi, Acta Mech. 100 (1993) 37.
class SimilarityHeap {
  public:
    struct Plane {
        double angle, friction_angle;  ///< [rad]
        double gravity;                ///< [m/s2]
    };
    struct Heap {
        double depth, radius;  ///< H, L [m]
        int dimension;         ///< 1 or 2
    };
    /// The heap at a time [s]: Runge-Kutta's steps of a thousandth of it.
    SimilarityHeap(const Plane& plane, const Heap& heap, double time);

    double centre() const { return centre_; }           ///< down the slope [m]
    double speed() const { return speed_; }             ///< of the centre [m/s]
    double length() const { return length_; }           ///< half of it, down the slope [m]
    double width() const { return width_; }             ///< half of it [m]
    double stretching() const { return stretching_; }   ///< of the length [1/s]
    double front() const { return centre_ + length_; }  ///< [m]
    double depth(double s, double y) const;             ///< along the normal [m]
    double velocity(double s) const { return speed_ + (s - centre_) * stretching_; }  ///< [m/s]

  private:
    double middle_depth_, centre_, speed_, length_, width_, stretching_;
};

}  // namespace talus::reference
