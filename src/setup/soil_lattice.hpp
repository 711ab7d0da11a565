#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "src/setup/point.hpp"

namespace talus {

inline constexpr std::uint8_t no_body = 255;

/// Bodies of soil on one square lattice: its cells become elements, their corners nodes.
struct SoilLattice {
    int dimension = 2;
    Point origin{};                          ///< corner of the first cell [m]
    double spacing = 0;                      ///< [m]
    std::array<long, 3> cells{1, 1, 1};      ///< along each axis
    std::vector<std::uint8_t> body_of_cell;  ///< no_body: none

    using Index = std::array<long, 3>;
    /// Body of the cell at an index, no_body outside.
    std::uint8_t body_at(const Index& cell) const;
    Point corner(const Index& index) const;

    struct Node {
        Index index;
        std::uint8_t body;   ///< the first of the bodies around
        std::uint8_t faces;  ///< as soil_field::faces
        /// Cells around the node, by body, in order of the lattice; no_body where there is none.
        std::array<std::uint8_t, 8> around;
        /// Cells of soil around it.
        int cell_count() const;
        /// All cells around are of soil.
        bool is_inside(int dimension) const { return cell_count() == 1 << dimension; }
    };
    /// The node at an index; its body is no_body if there is no soil around.
    Node node_at(const Index& index) const;
};

}  // namespace talus
