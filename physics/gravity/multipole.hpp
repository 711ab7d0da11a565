#pragma once
#include <array>
#include <cstddef>

namespace talus::gravity {

/// Components of symmetric tensors of three dimensions, in the order of storage.
inline constexpr std::array<std::array<std::size_t, 2>, 6> pair_axes{
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};
inline constexpr std::array<std::array<std::size_t, 3>, 10> triple_axes{{{0, 0, 0},
                                                                         {1, 1, 1},
                                                                         {2, 2, 2},
                                                                         {0, 0, 1},
                                                                         {0, 0, 2},
                                                                         {0, 1, 1},
                                                                         {1, 1, 2},
                                                                         {0, 2, 2},
                                                                         {1, 2, 2},
                                                                         {0, 1, 2}}};

/// Place of (a, b) in the storage of a symmetric tensor.
constexpr std::size_t pair_index(std::size_t a, std::size_t b) { return a == b ? a : a + b + 2; }

/// Mass of several particles and its distribution about their centre of mass.
struct Moments {
    double mass = 0;                 ///< [kg]
    std::array<double, 3> centre{};  ///< of mass [m]
    std::array<double, 6> second{};  ///< sum of m x_a x_b about the centre [kg m2]
    std::array<double, 10> third{};  ///< sum of m x_a x_b x_c about the centre [kg m3]

    /// Adds what a part adds to the second and third moments about this centre. The parts' first moments
    /// vanish about their own centres.
    void add_part(const Moments& part);
};

/// The trace-free moments times 3/2 and 5/2: with d from the centre, r = |d| and n = d/r, the potential is
/// -G (mass/r + quadrupole nn/r^3 + octupole nnn/r^4).
std::array<double, 6> quadrupole_of(const Moments& moments);
std::array<double, 10> octupole_of(const Moments& moments);

}  // namespace talus::gravity
