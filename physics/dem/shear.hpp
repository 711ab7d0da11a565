#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "domain/box.hpp"
#include "domain/particles.hpp"
#include "physics/dem/grain_rows.hpp"
#include "physics/dem/motion.hpp"
#include "physics/dem/vector3.hpp"

namespace talus::dem {

/// Velocity along x of the flow of a sheared box at the image within the box of height y; nothing moves in
/// the middle, nor in a box that is not sheared [m/s].
double shear_flow(const Box& box, double y);

/// Simple shear for ever: periodic images across y move along x (A. W. Lees, S. F. Edwards, J. Phys. C 5
/// (1972) 1921). A grain that leaves the box through the upper side comes back through the lower one,
/// displaced and slower along x.
///
/// Which bits come out must not depend on when lists are made. Hence the field of velocities always holds
/// those of the image within the box, and changes at the very step at which a grain crosses, while positions
/// run on until the next list, as along all periodic axes. The displacement of images is a whole number of
/// places at every step. Contacts see predicted velocities rounded to multiples of a power of two, 2^-50 of
/// the speed that carries the largest grain its radius in a step: the velocity of images is such a multiple,
/// and pairs see the same difference of velocities whichever image they look at.
class Shear {
  public:
    /// `box` aligned with `places`.
    Shear(const Box& box, const PeriodicPlaces& places, double time_step, double largest_radius);

    /// Positions are those of this step from now on.
    void go_to(std::uint64_t step);
    /// Of the images across the upper side, along x, at the step of the positions; within [0, length) [m].
    double offset() const { return offset_; }
    /// Of the images across the upper side, along x [m/s].
    double velocity() const { return velocity_; }
    /// In a step [m].
    double advance() const { return advance_; }
    /// Boxes along y that a place is above the box.
    double turns_of(double y) const;
    /// Velocity along x at the image that is so many boxes up, from one at that within the box, which is
    /// rounded as contacts see it [m/s].
    double placed(double velocity, double turns) const {
        return ((velocity + rounding_) - rounding_) + turns * velocity_;
    }

    /// In place of dem::drift(): positions advance by a step, velocities of grains that cross change.
    void drift(ParticleSet& grains, std::span<const ForceSum> rates, double time_step,
               const PeriodicPlaces& places);
    /// After rows.predict(): predicted velocities are those of the image that the position is of.
    void place_velocities(const ParticleSet& grains, GrainRows& rows) const;
    /// Of the image that is so many boxes below.
    Vector3<> brought_back(const Vector3<>& place, double turns) const {
        return {place.x - turns * offset_, place.y - turns * length_y_, place.z};
    }
    /// Positions along x and y are those of the image within the box along y.
    void bring_back(ParticleSet& grains) const;

    /// For a new list: copies stand where they were made; `needed` is 1 for those that are refreshed.
    void note_copies(const ParticleSet& grains, std::span<const std::uint8_t> needed);
    /// Moves refreshed copies across y, and their predicted velocities, with the box they stand in.
    void move_copies(GrainRows& rows) const;

    /// Square of a distance of which twice is the most that the gap of two grains can have shrunk from the
    /// list to the end of the next step [m2]. `start`: positions at the time of the list; `listed`: greatest
    /// distance of centres up to which pairs were listed [m].
    double moved2(const ParticleSet& grains, std::span<const ForceSum> rates,
                  const std::array<StaggeredVector<double>, 3>& start, double listed) const;

  private:
    double lower_, length_x_, length_y_, time_step_;
    double advance_;   ///< of the images across the upper side in a step [m]
    double velocity_;  ///< advance_ over the step, rounded to a multiple of the unit below [m/s]
    double rounding_;  ///< adding and subtracting it rounds to such a multiple [m/s]
    std::uint64_t step_ = 0, listed_step_ = 0;
    double offset_ = 0;
    struct Copy {
        std::size_t row;
        double turns;  ///< boxes along y that it stands beyond its grain
    };
    std::vector<Copy> copies_;  ///< across y
};

}  // namespace talus::dem
