#include "src/setup/soil_lattice.hpp"

#include <algorithm>

#include "domain/soil_fields.hpp"

namespace talus {

std::uint8_t SoilLattice::body_at(const Index& cell) const {
    for (std::size_t a = 0; a < 3; ++a)
        if (cell[a] < 0 || cell[a] >= cells[a]) return no_body;
    return body_of_cell[static_cast<std::size_t>((cell[2] * cells[1] + cell[1]) * cells[0] + cell[0])];
}

Point SoilLattice::corner(const Index& index) const {
    Point at{};
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a)
        at[a] = origin[a] + static_cast<double>(index[a]) * spacing;
    return at;
}

int SoilLattice::Node::cell_count() const {
    return static_cast<int>(
        std::count_if(around.begin(), around.end(), [](std::uint8_t body_) { return body_ != no_body; }));
}

SoilLattice::Node SoilLattice::node_at(const Index& index) const {
    Node node{index, no_body, 0, {}};
    node.around.fill(no_body);
    for (unsigned k = 0; k < 1u << dimension; ++k) {
        Index cell = index;
        for (unsigned a = 0; a < static_cast<unsigned>(dimension); ++a)
            if (!(k >> a & 1)) --cell[a];
        node.around[k] = body_at(cell);
        node.body = std::min(node.body, node.around[k]);
    }
    if (node.body == no_body) return node;
    for (unsigned face = 0; face < 2 * static_cast<unsigned>(dimension); ++face) {
        bool bare = true;
        for (unsigned k = 0; k < 1u << dimension; ++k)
            if ((k >> (face / 2) & 1) == face % 2) bare &= node.around[k] == no_body;
        if (bare) node.faces = static_cast<std::uint8_t>(node.faces | 1u << face);
    }
    if (node.faces == 0 && !node.is_inside(dimension)) node.faces = soil_field::turns_inwards;
    return node;
}

}  // namespace talus
