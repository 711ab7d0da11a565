#pragma once
#include <array>
#include <cstdint>

namespace talus {

/// What happens at the two ends of an axis.
enum class Boundary : std::uint8_t { open, periodic, reflecting };

/// The region of space of a run. Positions are not limited along open axes.
struct Box {
    int dimension = 3;
    std::array<double, 3> lower{};       ///< [m]; not used along open axes
    std::array<double, 3> upper{};       ///< [m]
    std::array<Boundary, 3> boundary{};  ///< open by default
    /// Rate at which periodic images across y move along x, over the length along y [1/s]; the box is then
    /// periodic along all axes. A. W. Lees, S. F. Edwards, J. Phys. C 5 (1972) 1921.
    double shear_rate = 0;

    double length(int axis) const {
        return upper[static_cast<std::size_t>(axis)] - lower[static_cast<std::size_t>(axis)];
    }
};

}  // namespace talus
