#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "domain/box.hpp"
#include "domain/column_storage.hpp"
#include "domain/particles.hpp"
#include "physics/dem/force_sum.hpp"
#include "physics/dem/vector3.hpp"

namespace talus::dem {

/// Coordinates along periodic axes are kept to whole multiples of a power of two, about 2^-50 of the box, so
/// that moving a grain by the length of the box is exact: what a pair sees of each other has the same bits
/// whichever image of a grain is looked at, and whenever grains are brought back into the box.
class PeriodicPlaces {
  public:
    explicit PeriodicPlaces(const Box& box);
    /// Nearest place; a displacement is brought to one before it is added, for the sum would be rounded
    /// twice.
    template <class Real>
    Real operator()(int axis, const Real& coordinate) const {
        const double shift = shifts_[static_cast<std::size_t>(axis)];
        return (coordinate + shift) - shift;
    }
    /// The box with its edges at such places.
    Box aligned(Box box) const;

  private:
    std::array<double, 3> shifts_{};
};

/// x += dt v + dt^2/2 a of the own grains: first part of the velocity Verlet step. L. Verlet, Phys. Rev. 159
/// (1967) 98; W. C. Swope et al., J. Chem. Phys. 76 (1982) 637. `rates`: a in place of the sums.
void drift(ParticleSet& grains, std::span<const ForceSum> rates, double time_step,
           const PeriodicPlaces& places);

/// The first half of the kick, v += dt/2 a, of the own grains from `begin` on and below `end`. Rates give
/// way to sums, which are zero.
void begin_kick(ParticleSet& grains, std::span<ForceSum> rates, double time_step, std::size_t begin,
                std::size_t end);

/// For grains with bonds, after begin_kick(): velocities and angular velocities are those of the middle of
/// the step, what springs are stretched by within the step, to second order.
void keep_half_step(ParticleSet& grains);

/// Rates from the fields of accelerations, and the reverse.
void put_rates(const ParticleSet& grains, std::span<ForceSum> rates);
void put_accelerations(std::span<const ForceSum> rates, ParticleSet& grains);

/// What turns a grain's sums of forces into its acceleration, made anew with the order of grains.
struct Responses {
    StaggeredVector<double> acceleration;          ///< of one unit of force [m s-2]; 0: the grain is held
    std::array<StaggeredVector<double>, 3> start;  ///< where each grain was at the time [m]
};

/// Velocity that grains which are not held are given besides that of forces: `acceleration` times either
/// time.
struct Impulse {
    std::array<const double*, 3> acceleration{};  ///< [m s-2]
    double now = 0;                               ///< by finish_step() [s]; 0: none
    double next = 0;                              ///< before the next drift(), by whoever asks for it [s]
    /// What acts besides contacts and gravity throughout, or nothing [m s-2].
    std::array<const double*, 3> steady{};
};

/// Accelerations of now take the place of the sums; the other half of the kick, v += dt/2 a with dt =
/// `kick_step`, then times `remaining`, which is 1 unless motion is damped. Returns the square of the largest
/// distance from `responses.start` that a grain will have after the next drift() of the same time step [m2];
/// infinite if any value is not finite.
double finish_step(ParticleSet& grains, std::span<ForceSum> sums, const Responses& responses,
                   const Vector3<>& gravity, const Impulse& impulse, double kick_step, double time_step,
                   double remaining = 1);

}  // namespace talus::dem
