#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "domain/lanes.hpp"
#include "domain/particles.hpp"
#include "physics/dem/force_sum.hpp"
#include "physics/dem/laws/kinematics.hpp"

namespace talus::dem {

/// What a contact needs to know of a grain, side by side in memory: contacts reach for grains out of order.
class GrainRows {
  public:
    static constexpr std::size_t width = 12, refreshed = 10;  ///< values a row, and those that change
    static constexpr std::size_t velocity_at = 4;             ///< place of its first component
    using Pointers = std::array<const double*, lane_count>;

    /// For new grains and copies, as they are at rest. `units` [N]: force_unit() of each grain; `material` of
    /// each body.
    void reset(const ParticleSet& grains, std::span<const double> units,
               std::span<const std::uint8_t> material);
    /// Positions of the own grains from `begin` on and below `end`, and their velocities and angular
    /// velocities of the end of the step as far as they are known: v + dt a, a the `rates` in place of the
    /// sums. A contact law must see velocities of the same time as positions, not those of half a step
    /// before: D. Vyas, J. M. Ottino, R. M. Lueptow, P. B. Umbanhowar, arXiv 2410.14798 (2024).
    void predict(const ParticleSet& grains, std::span<const ForceSum> rates, double time_step,
                 std::size_t begin, std::size_t end);
    /// The same of some own grains, to the same bits.
    void predict(const ParticleSet& grains, std::span<const ForceSum> rates, double time_step,
                 std::span<const std::uint32_t> some);

    /// In place of what predict() found for grain i.
    void put_velocities(std::size_t i, const Vector3<>& velocity, const Vector3<>& angular_velocity) {
        double* row = values_.data() + i * width;
        row[4] = velocity.x;
        row[5] = velocity.y;
        row[6] = velocity.z;
        row[7] = angular_velocity.x;
        row[8] = angular_velocity.y;
        row[9] = angular_velocity.z;
    }

    const double* operator[](std::size_t i) const { return values_.data() + i * width; }
    std::span<double> values() { return values_; }
    std::uint8_t material(std::size_t i) const { return material_[i]; }

    std::size_t bytes() const { return values_.capacity() * sizeof(double) + material_.capacity(); }

  private:
    std::vector<double> values_;  ///< x y z radius | v_x v_y v_z w_x | w_y w_z mass 1/unit
    std::vector<std::uint8_t> material_;
};

/// A grain and its place, of doubles or lanes.
template <class Real>
struct PlacedGrain {
    Vector3<Real> position;
    Grain<Real> grain;
    Real units_per_force;  ///< [1/N]
};

inline PlacedGrain<double> placed_grain(const double* row) {
    return {{row[0], row[1], row[2]},
            {{row[4], row[5], row[6]}, {row[7], row[8], row[9]}, row[3], row[10]},
            row[11]};
}
inline PlacedGrain<Lanes> placed_grain(const GrainRows::Pointers& rows) {
    PlacedGrain<Lanes> g;
    load_two(rows, 0, g.position.x, g.position.y);
    load_two(rows, 2, g.position.z, g.grain.radius);
    load_two(rows, 4, g.grain.velocity.x, g.grain.velocity.y);
    load_two(rows, 6, g.grain.velocity.z, g.grain.angular_velocity.x);
    load_two(rows, 8, g.grain.angular_velocity.y, g.grain.angular_velocity.z);
    load_two(rows, 10, g.grain.mass, g.units_per_force);
    return g;
}

}  // namespace talus::dem
