#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "domain/cell_table.hpp"
#include "domain/particles.hpp"
#include "physics/water/settings.hpp"

namespace talus::water {

/// What a body is; if it is a buffer, a box at an open end of the water, as deep along one axis as the kernel
/// reaches, whose particles move along that axis alone and carry what the water on the other side of its
/// inner face lacks.
struct Buffer {
    enum class Kind : std::uint8_t { water, wall, inflow, outflow };
    Kind kind = Kind::water;                 ///< of the body; of water and walls the rest has no meaning
    int axis = 0;                            ///< along which water flows
    double sign = 1;                         ///< 1: towards greater places, else -1
    std::array<double, 3> lower{}, upper{};  ///< corners [m]
    double particle_volume = 0;              ///< of an inflow's particles [m3]
    bool holds_pressure = false;             ///< else it takes that of the water in front, as inflows do
    std::optional<double> surface{};         ///< height against gravity whose weight is held; none: p0 [m]

    bool is_open() const { return kind == Kind::inflow || kind == Kind::outflow; }
    /// Distance of a place behind the inner face, out of the water [m].
    double behind_face(const std::array<double, 3>& x) const {
        const auto a = static_cast<std::size_t>(axis);
        const bool face_is_upper = (kind == Kind::inflow) == (sign > 0);
        return face_is_upper ? upper[a] - x[a] : x[a] - lower[a];
    }
    double depth() const {
        const auto a = static_cast<std::size_t>(axis);
        return upper[a] - lower[a];
    }
    /// Whether a place has the box's coordinates along the other axes.
    bool is_beside(const std::array<double, 3>& x, int dimension) const {
        for (int d = 0; d < dimension; ++d) {
            const auto a = static_cast<std::size_t>(d);
            if (d != axis && (x[a] < lower[a] || x[a] > upper[a])) return false;
        }
        return true;
    }
};

/// Makes partners of the own particles of buffers: as walls that stick, with velocities of their own. After
/// prepare_partners(). `buffers`: one a body.
void prepare_buffers(ParticleSet& particles, std::span<const Buffer> buffers);

/// Pressure of the own particles of buffers, and density and mass with it: of the water in front as walls
/// have it (wall_pass()), or what an outflow holds; the velocity of an outflow's is the mean of the water in
/// front along its axis, never inwards. Returns for each body how many of them see water. Reads position and
/// partner_* of water.
std::vector<std::uint64_t> buffer_pass(ParticleSet& particles, const CellTable& table,
                                       const Settings& settings, std::span<const Buffer> buffers);

}  // namespace talus::water
