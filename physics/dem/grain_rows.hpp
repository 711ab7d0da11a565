#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "domain/lanes.hpp"
#include "domain/particles.hpp"
#include "physics/dem/laws/kinematics.hpp"

namespace talus::dem {

/// What a contact needs to know of a grain, side by side in memory: contacts reach for grains out of order.
class GrainRows {
  public:
    static constexpr std::size_t width = 12;
    using Pointers = std::array<const double*, lane_count>;

    /// For new grains and copies: what stays the same. `units` [N]: force_unit() of each grain.
    void reset(const ParticleSet& grains, std::span<const double> units);
    /// Takes over positions and predicted velocities of grains [begin, end).
    void update(const ParticleSet& grains, std::size_t begin, std::size_t end);

    const double* operator[](std::size_t i) const { return values_.data() + i * width; }

    std::size_t bytes() const { return values_.capacity() * sizeof(double); }

  private:
    std::vector<double> values_;  ///< x y z radius | v_x v_y v_z mass | w_x w_y w_z 1/unit
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
            {{row[4], row[5], row[6]}, {row[8], row[9], row[10]}, row[3], row[7]},
            row[11]};
}
inline PlacedGrain<Lanes> placed_grain(const GrainRows::Pointers& rows) {
    PlacedGrain<Lanes> g;
    load_two(rows, 0, g.position.x, g.position.y);
    load_two(rows, 2, g.position.z, g.grain.radius);
    load_two(rows, 4, g.grain.velocity.x, g.grain.velocity.y);
    load_two(rows, 6, g.grain.velocity.z, g.grain.mass);
    load_two(rows, 8, g.grain.angular_velocity.x, g.grain.angular_velocity.y);
    load_two(rows, 10, g.grain.angular_velocity.z, g.units_per_force);
    return g;
}

}  // namespace talus::dem
