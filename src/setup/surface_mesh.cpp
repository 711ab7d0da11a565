#include "src/setup/surface_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

namespace talus {

namespace {

/// +1 or -1 if the edge from a to b passes the point (y, z) upwards or downwards on the side of greater y,
/// else 0. The crossing is computed from the lower end, so that both triangles of an edge find the same.
int passes(const Point& a, const Point& b, double y, double z) {
    const bool up = a[2] <= z && z < b[2];
    if (!up && !(b[2] <= z && z < a[2])) return 0;
    const Point &low = up ? a : b, &high = up ? b : a;
    const double at = low[1] + (z - low[2]) / (high[2] - low[2]) * (high[1] - low[1]);
    const auto [least, greatest] = std::minmax(a[1], b[1]);
    if (!(y < std::clamp(at, least, greatest))) return 0;
    return up ? 1 : -1;
}

double height_of_plane(const Point& a, const Point& b, const Point& c, double y, double z) {
    const Point normal = cross(minus(b, a), minus(c, a));
    const auto [least, greatest] = std::minmax({a[0], b[0], c[0]});
    if (normal[0] == 0) return least;
    const double x = a[0] - (normal[1] * (y - a[1]) + normal[2] * (z - a[2])) / normal[0];
    return std::clamp(x, least, greatest);
}

}  // namespace

VolumeIntegrals integrate(const Polyhedron& surface) {
    VolumeIntegrals result{};
    if (surface.vertices.empty()) return result;
    // Signed tetrahedra from a point amid the surface; moments of a tetrahedron with a corner at the origin.
    Point origin{};
    for (const Point& vertex : surface.vertices)
        origin = plus(origin, times(1 / static_cast<double>(surface.vertices.size()), vertex));
    Point first{};
    std::array<Point, 3> second{};
    for (const Polyhedron::Triangle& triangle : surface.triangles) {
        const Point a = minus(surface.vertices[triangle[0]], origin),
                    b = minus(surface.vertices[triangle[1]], origin),
                    c = minus(surface.vertices[triangle[2]], origin), sum = plus(a, plus(b, c));
        const double volume = dot(a, cross(b, c)) / 6;
        result.volume += volume;
        first = plus(first, times(volume / 4, sum));
        for (std::size_t p = 0; p < 3; ++p)
            for (std::size_t q = 0; q < 3; ++q)
                second[p][q] += volume / 20 * (sum[p] * sum[q] + a[p] * a[q] + b[p] * b[q] + c[p] * c[q]);
    }
    if (result.volume == 0) return result;
    const Point arm = times(1 / result.volume, first);
    result.centroid = plus(origin, arm);
    for (std::size_t p = 0; p < 3; ++p)
        for (std::size_t q = 0; q < 3; ++q)
            result.second_moments[p][q] = second[p][q] - result.volume * arm[p] * arm[q];
    return result;
}

std::string why_not_closed(const Polyhedron& surface) {
    if (surface.triangles.empty()) return "has no faces";
    struct Sides {
        int forward = 0, backward = 0;
    };
    std::map<std::pair<std::uint32_t, std::uint32_t>, Sides> edges;
    for (const Polyhedron::Triangle& triangle : surface.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t from = triangle[k], to = triangle[(k + 1) % 3];
            Sides& sides = edges[std::minmax(from, to)];
            ++(from < to ? sides.forward : sides.backward);
        }
    std::uint64_t open = 0, turned = 0;
    std::string where;
    for (const auto& [ends, sides] : edges) {
        if (sides.forward == sides.backward) continue;
        ++((sides.forward + sides.backward) % 2 == 1 ? open : turned);
        if (!where.empty()) continue;
        const Point &a = surface.vertices[ends.first], &b = surface.vertices[ends.second];
        where = fmt::format("the first from ({:g}, {:g}, {:g}) to ({:g}, {:g}, {:g})", a[0], a[1], a[2], b[0],
                            b[1], b[2]);
    }
    if (open > 0) return fmt::format("is not closed: {} of {} edges are open, {}", open, edges.size(), where);
    if (turned > 0)
        return fmt::format("has faces of opposite orientation at {} of {} edges, {}", turned, edges.size(),
                           where);
    return {};
}

SurfaceMesh::SurfaceMesh(Polyhedron surface) : surface_(std::move(surface)), integrals_(integrate(surface_)) {
    lower_ = upper_ = surface_.vertices.front();
    for (const Point& vertex : surface_.vertices)
        for (std::size_t a = 0; a < 3; ++a) {
            lower_[a] = std::min(lower_[a], vertex[a]);
            upper_[a] = std::max(upper_[a], vertex[a]);
        }
    // About two triangles of each side a bin.
    const auto across =
        static_cast<std::size_t>(std::sqrt(static_cast<double>(surface_.triangles.size()) / 4));
    for (std::size_t a = 1; a < 3; ++a) {
        bins_[a] = std::max<std::size_t>(across, 1);
        bins_per_metre_[a] = static_cast<double>(bins_[a]) / (upper_[a] - lower_[a]);
    }
    const auto for_each_bin = [this](const Polyhedron::Triangle& triangle, auto&& visit) {
        std::array<std::size_t, 3> from{}, to{};
        for (std::size_t a = 1; a < 3; ++a) {
            const auto [least, greatest] =
                std::minmax({surface_.vertices[triangle[0]][a], surface_.vertices[triangle[1]][a],
                             surface_.vertices[triangle[2]][a]});
            from[a] = bin_along(a, least);
            to[a] = bin_along(a, greatest);
        }
        for (std::size_t z = from[2]; z <= to[2]; ++z)
            for (std::size_t y = from[1]; y <= to[1]; ++y) visit(z * bins_[1] + y);
    };
    bin_start_.assign(bins_[1] * bins_[2] + 1, 0);
    for (const Polyhedron::Triangle& triangle : surface_.triangles)
        for_each_bin(triangle, [this](std::size_t bin) { ++bin_start_[bin + 1]; });
    for (std::size_t bin = 1; bin < bin_start_.size(); ++bin) bin_start_[bin] += bin_start_[bin - 1];
    in_bin_.resize(bin_start_.back());
    std::vector<std::uint32_t> next(bin_start_.begin(), bin_start_.end() - 1);
    for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t)
        for_each_bin(surface_.triangles[t], [&](std::size_t bin) { in_bin_[next[bin]++] = t; });
}

std::size_t SurfaceMesh::bin_along(std::size_t axis, double coordinate) const {
    const double bin = (coordinate - lower_[axis]) * bins_per_metre_[axis];
    return std::min(static_cast<std::size_t>(bin), bins_[axis] - 1);
}

template <class Visit>
void SurfaceMesh::for_each_crossing(double y, double z, Visit&& visit) const {
    if (!(lower_[1] <= y && y <= upper_[1] && lower_[2] <= z && z <= upper_[2])) return;
    const std::size_t bin = bin_along(2, z) * bins_[1] + bin_along(1, y);
    for (std::uint32_t k = bin_start_[bin]; k < bin_start_[bin + 1]; ++k) {
        const Polyhedron::Triangle& triangle = surface_.triangles[in_bin_[k]];
        const Point &a = surface_.vertices[triangle[0]], &b = surface_.vertices[triangle[1]],
                    &c = surface_.vertices[triangle[2]];
        if (const int sign = passes(a, b, y, z) + passes(b, c, y, z) + passes(c, a, y, z))
            visit(height_of_plane(a, b, c, y, z), sign);
    }
}

void SurfaceMesh::crossings(double y, double z, std::vector<Crossing>& found) const {
    found.clear();
    for_each_crossing(y, z, [&found](double x, int sign) { found.push_back({x, sign}); });
}

int SurfaceMesh::winding_number(const Point& point) const {
    int sum = 0;
    for_each_crossing(point[1], point[2], [&](double x, int sign) { sum += x > point[0] ? sign : 0; });
    return sum;
}

}  // namespace talus
