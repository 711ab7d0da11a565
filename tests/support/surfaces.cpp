#include "tests/support/surfaces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numbers>

namespace talus::test {

Polyhedron icosphere(int cuts) {
    Polyhedron surface;
    const double g = std::numbers::phi;
    for (const double s : {-1.0, 1.0})
        for (const double t : {-g, g})
            for (const Point& corner : {Point{0, s, t}, Point{s, t, 0}, Point{t, 0, s}})
                surface.vertices.push_back(times(1 / std::hypot(1, g), corner));
    const auto count = static_cast<std::uint32_t>(surface.vertices.size());
    const double edge = 2 / std::hypot(1, g);
    const auto are_close = [&](std::uint32_t i, std::uint32_t j) {
        return norm(minus(surface.vertices[i], surface.vertices[j])) < 1.01 * edge;
    };
    for (std::uint32_t i = 0; i < count; ++i)
        for (std::uint32_t j = i + 1; j < count; ++j)
            for (std::uint32_t k = j + 1; k < count; ++k) {
                if (!are_close(i, j) || !are_close(j, k) || !are_close(k, i)) continue;
                const Point &a = surface.vertices[i], &b = surface.vertices[j], &c = surface.vertices[k];
                if (dot(a, cross(b, c)) > 0)
                    surface.triangles.push_back({i, j, k});
                else
                    surface.triangles.push_back({i, k, j});
            }
    for (int cut = 0; cut < cuts; ++cut) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t i, std::uint32_t j) {
            const auto [at, is_new] = middles.try_emplace(std::minmax(i, j), surface.vertices.size());
            if (is_new) {
                const Point sum = plus(surface.vertices[i], surface.vertices[j]);
                surface.vertices.push_back(times(1 / norm(sum), sum));
            }
            return at->second;
        };
        std::vector<Polyhedron::Triangle> finer;
        for (const auto& [a, b, c] : surface.triangles) {
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            for (const Polyhedron::Triangle& part :
                 {Polyhedron::Triangle{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}})
                finer.push_back(part);
        }
        surface.triangles = finer;
    }
    return surface;
}

std::string obj_text(const Polyhedron& surface) {
    std::string text = "# a surface\n";
    for (const Point& v : surface.vertices)
        text += fmt::format("v {:.17g} {:.17g} {:.17g}\n", v[0], v[1], v[2]);
    for (const auto& [a, b, c] : surface.triangles) text += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
    return text;
}

}  // namespace talus::test
