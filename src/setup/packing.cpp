#include "src/setup/packing.hpp"

#include <algorithm>
#include <cmath>

namespace talus {

UnitCell lattice_cell(Lattice lattice, int dimension) {
    if (lattice == Lattice::close_packed && dimension == 3) {
        const double edge = std::cbrt(4.0);
        return {{edge, edge, edge}, {{.25, .25, .25}, {.75, .75, .25}, {.75, .25, .75}, {.25, .75, .75}}};
    }
    if (lattice == Lattice::close_packed && dimension == 2) {
        const double edge = std::sqrt(2 / std::sqrt(3.0));  // rows of this spacing, sqrt(3)/2 of it apart
        return {{edge, std::sqrt(3.0) * edge, 1}, {{.25, .25, .5}, {.75, .75, .5}}};
    }
    return {{1, 1, 1}, {{.5, .5, .5}}};
}

void for_each_point(const BodyShape& shape, const UnitCell& cell, double spacing, int dimension,
                    const std::function<void(const Point&)>& visit) {
    const bool fitted = cell.fits_boxes && std::holds_alternative<BoxShape>(shape);
    const Point anchor = fitted ? Point{} : centre(shape);
    const BodyShape local = moved(shape, times(-1, anchor));
    const BoxShape around = bounds(local, dimension);
    Point origin{}, edges{1, 1, 1};
    std::array<long, 3> count{1, 1, 1};
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
        edges[a] = cell.edges[a] * spacing;
        if (fitted) {
            const double length = around.upper[a] - around.lower[a];
            count[a] = std::max(1L, std::lround(length / edges[a]));
            edges[a] = length / static_cast<double>(count[a]);
            origin[a] = around.lower[a];
        } else {
            const double reach = std::max(-around.lower[a], around.upper[a]);
            const auto each_side = static_cast<long>(reach / edges[a]) + 2;
            count[a] = 2 * each_side;
            origin[a] = -static_cast<double>(each_side) * edges[a];
        }
    }
    for (long z = 0; z < count[2]; ++z)
        for (long y = 0; y < count[1]; ++y)
            for (long x = 0; x < count[0]; ++x)
                for (const Point& in_cell : cell.points) {
                    const std::array<long, 3> at{x, y, z};
                    Point point{};
                    for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a)
                        point[a] = origin[a] + (static_cast<double>(at[a]) + in_cell[a]) * edges[a];
                    if (fitted || contains(local, point, dimension)) visit(plus(anchor, point));
                }
}

}  // namespace talus
