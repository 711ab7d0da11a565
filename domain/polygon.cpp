#include "domain/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talus {

namespace {

bool is_inside(const Polygon::Ring& ring, double x, double y) {
    bool inside = false;
    for (std::size_t k = 0, before = ring.size() - 1; k < ring.size(); before = k++) {
        const auto &a = ring[k], &b = ring[before];
        if ((a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
            inside = !inside;
    }
    return inside;
}

double signed_area(const Polygon::Ring& ring) {
    double sum = 0;
    for (std::size_t k = 0, before = ring.size() - 1; k < ring.size(); before = k++)
        sum += (ring[before][0] - ring[0][0]) * (ring[k][1] - ring[0][1]) -
               (ring[k][0] - ring[0][0]) * (ring[before][1] - ring[0][1]);
    return sum / 2;
}

}  // namespace

bool Polygon::contains(double x, double y) const {
    bool inside = false;
    for (const Ring& ring : rings) inside = inside != is_inside(ring, x, y);
    return inside;
}

double Polygon::area() const {
    double sum = 0;
    for (const Ring& ring : rings) {
        if (ring.empty()) continue;
        int around = 0;
        for (const Ring& other : rings)
            if (&other != &ring && is_inside(other, ring[0][0], ring[0][1])) ++around;
        sum += (around % 2 == 0 ? 1 : -1) * std::abs(signed_area(ring));
    }
    return sum;
}

std::array<double, 2> Polygon::lower() const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::array<double, 2> corner{infinity, infinity};
    for (const Ring& ring : rings)
        for (const auto& point : ring)
            corner = {std::min(corner[0], point[0]), std::min(corner[1], point[1])};
    return corner;
}

std::array<double, 2> Polygon::upper() const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::array<double, 2> corner{-infinity, -infinity};
    for (const Ring& ring : rings)
        for (const auto& point : ring)
            corner = {std::max(corner[0], point[0]), std::max(corner[1], point[1])};
    return corner;
}

}  // namespace talus
