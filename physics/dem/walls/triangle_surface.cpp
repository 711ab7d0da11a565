#include "physics/dem/walls/triangle_surface.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace talus::dem {

namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Distances closer than this share are the same.
constexpr double same_distance = 1e-12;
constexpr double least_width = 1e-9;

Vector3<> area_vector(const TriangleMesh& mesh, const TriangleMesh::Triangle& t) {
    return cross(mesh.vertices[t[1]] - mesh.vertices[t[0]], mesh.vertices[t[2]] - mesh.vertices[t[0]]);
}

bool has_area(const TriangleMesh& mesh, const TriangleMesh::Triangle& t) {
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vector3<> side = mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[k]];
        longest = std::max(longest, dot(side, side));
    }
    return norm(area_vector(mesh, t)) > least_width * longest;
}

Vector3<> least(const Vector3<>& a, const Vector3<>& b) {
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
Vector3<> greatest(const Vector3<>& a, const Vector3<>& b) {
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

}  // namespace

MeshDefects find_defects(const TriangleMesh& mesh) {
    MeshDefects defects;
    std::map<Edge, std::size_t> edges;
    for (const TriangleMesh::Triangle& t : mesh.triangles) {
        if (!has_area(mesh, t)) {
            ++defects.without_area;
            continue;
        }
        for (std::size_t k = 0; k < 3; ++k) ++edges[std::minmax(t[k], t[(k + 1) % 3])];
    }
    for (const auto& [ends, count] : edges) {
        if (count > 2) ++defects.crowded_edges;
        if (count != 1) continue;
        if (defects.open_edges++ == 0)
            defects.open_edge = 0.5 * (mesh.vertices[ends.first] + mesh.vertices[ends.second]);
    }
    return defects;
}

void remove_triangles_without_area(TriangleMesh& mesh) {
    std::erase_if(mesh.triangles, [&](const TriangleMesh::Triangle& t) { return !has_area(mesh, t); });
}

TriangleSurface::TriangleSurface(TriangleMesh mesh, double smooth_angle, double usual_reach)
    : mesh_(std::move(mesh)) {
    for (const TriangleMesh::Triangle& t : mesh_.triangles) {
        const Vector3<> area = area_vector(mesh_, t);
        normals_.push_back((1 / norm(area)) * area);
    }
    lower_ = upper_ = mesh_.vertices[mesh_.triangles.front()[0]];
    for (const TriangleMesh::Triangle& t : mesh_.triangles)
        for (const std::uint32_t corner : t) {
            lower_ = least(lower_, mesh_.vertices[corner]);
            upper_ = greatest(upper_, mesh_.vertices[corner]);
        }
    find_edges();
    find_parts(smooth_angle);
    fill_cells(usual_reach);
}

void TriangleSurface::find_edges() {
    const auto triangle_count = static_cast<std::uint32_t>(mesh_.triangles.size());
    std::map<Edge, std::uint32_t> known;
    for (const TriangleMesh::Triangle& t : mesh_.triangles) {
        std::array<std::uint32_t, 3> sides{};
        for (std::size_t k = 0; k < 3; ++k) {
            const Edge ends = std::minmax(t[k], t[(k + 1) % 3]);
            const auto [at, is_new] = known.try_emplace(ends, static_cast<std::uint32_t>(ends_.size()));
            if (is_new) ends_.push_back({ends.first, ends.second});
            sides[k] = at->second;
        }
        edges_.push_back(sides);
    }
    const auto collect = [&](std::size_t count, const auto& of_triangle) {
        Lists lists{std::vector<std::uint32_t>(count + 1, 0),
                    std::vector<std::uint32_t>(std::size_t{3} * triangle_count)};
        for (std::uint32_t t = 0; t < triangle_count; ++t)
            for (const std::uint32_t item : of_triangle[t]) ++lists.start[item + 1];
        std::partial_sum(lists.start.begin(), lists.start.end(), lists.start.begin());
        std::vector<std::uint32_t> next = lists.start;
        for (std::uint32_t t = 0; t < triangle_count; ++t)
            for (const std::uint32_t item : of_triangle[t]) lists.items[next[item]++] = t;
        return lists;
    };
    of_edge_ = collect(ends_.size(), edges_);
    of_vertex_ = collect(mesh_.vertices.size(), mesh_.triangles);
}

void TriangleSurface::find_parts(double smooth_angle) {
    const double least_cosine = std::cos(smooth_angle);
    constexpr std::uint32_t none = 0xffffffff;
    part_.assign(mesh_.triangles.size(), none);
    std::vector<std::uint32_t> open;
    for (std::uint32_t seed = 0; seed < part_.size(); ++seed) {
        if (part_[seed] != none) continue;
        part_[seed] = part_count_;
        open.assign(1, seed);
        while (!open.empty()) {
            const std::uint32_t t = open.back();
            open.pop_back();
            for (const std::uint32_t edge : edges_[t])
                for (const std::uint32_t other : of_edge_[edge]) {
                    if (of_edge_[edge].size() > 2 || part_[other] != none) continue;
                    // The same side of both, whichever way their corners run.
                    const auto runs_up = [&](std::uint32_t triangle) {
                        const TriangleMesh::Triangle& corners = mesh_.triangles[triangle];
                        const auto k = static_cast<std::size_t>(std::ranges::find(edges_[triangle], edge) -
                                                                edges_[triangle].begin());
                        return corners[k] == ends_[edge][0];
                    };
                    const double cosine =
                        dot(normals_[t], normals_[other]) * (runs_up(t) == runs_up(other) ? -1 : 1);
                    if (cosine < least_cosine) continue;
                    part_[other] = part_count_;
                    open.push_back(other);
                }
        }
        ++part_count_;
    }
}

template <class Visit>
void TriangleSurface::for_each_cell(const Vector3<>& low, const Vector3<>& high, Visit&& visit) const {
    const auto range = [&](double from, double to, double origin, std::size_t axis) {
        const double limit = static_cast<double>(cells_[axis] - 1);
        return std::array{
            static_cast<std::int64_t>(std::clamp((from - origin) * cells_per_metre_, 0.0, limit)),
            static_cast<std::int64_t>(std::clamp((to - origin) * cells_per_metre_, 0.0, limit))};
    };
    const auto x = range(low.x, high.x, lower_.x, 0), y = range(low.y, high.y, lower_.y, 1),
               z = range(low.z, high.z, lower_.z, 2);
    for (std::int64_t k = z[0]; k <= z[1]; ++k)
        for (std::int64_t j = y[0]; j <= y[1]; ++j)
            for (std::int64_t i = x[0]; i <= x[1]; ++i)
                visit(static_cast<std::size_t>((k * cells_[1] + j) * cells_[0] + i),
                      Vector3<>{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
}

void TriangleSurface::fill_cells(double usual_reach) {
    double extent = 0;
    std::vector<std::array<Vector3<>, 2>> boxes;
    for (const TriangleMesh::Triangle& t : mesh_.triangles) {
        const Vector3<>&a = mesh_.vertices[t[0]], &b = mesh_.vertices[t[1]], &c = mesh_.vertices[t[2]];
        boxes.push_back({least(a, least(b, c)), greatest(a, greatest(b, c))});
        const Vector3<> size = boxes.back()[1] - boxes.back()[0];
        extent += std::max({size.x, size.y, size.z}) / static_cast<double>(mesh_.triangles.size());
    }
    // Cells of the reach, if there are not too many of them.
    const Vector3<> size = upper_ - lower_;
    const double most_cells = 64 + 16 * static_cast<double>(mesh_.triangles.size());
    double cell = std::max(2 * usual_reach, 0.25 * extent);
    const auto cells_along = [&](double length) { return std::floor(length / cell) + 1; };
    while (cells_along(size.x) * cells_along(size.y) * cells_along(size.z) > most_cells) cell *= 1.25;
    cells_per_metre_ = 1 / cell;
    cells_ = {static_cast<std::int64_t>(cells_along(size.x)), static_cast<std::int64_t>(cells_along(size.y)),
              static_cast<std::int64_t>(cells_along(size.z))};

    const auto for_each_cell_of = [&](std::uint32_t t, auto&& visit) {
        const Vector3<>& n = normals_[t];
        const double half = 0.5001 * cell * (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
        for_each_cell(boxes[t][0], boxes[t][1], [&](std::size_t index, const Vector3<>& place) {
            const Vector3<> middle = lower_ + cell * (place + Vector3<>{0.5, 0.5, 0.5});
            if (std::abs(dot(middle - mesh_.vertices[mesh_.triangles[t][0]], n)) <= half) visit(index);
        });
    };
    const auto triangle_count = static_cast<std::uint32_t>(mesh_.triangles.size());
    of_cell_.start.assign(static_cast<std::size_t>(cells_[0] * cells_[1] * cells_[2]) + 1, 0);
    for (std::uint32_t t = 0; t < triangle_count; ++t)
        for_each_cell_of(t, [&](std::size_t index) { ++of_cell_.start[index + 1]; });
    std::partial_sum(of_cell_.start.begin(), of_cell_.start.end(), of_cell_.start.begin());
    of_cell_.items.resize(of_cell_.start.back());
    std::vector<std::uint32_t> next = of_cell_.start;
    for (std::uint32_t t = 0; t < triangle_count; ++t)
        for_each_cell_of(t, [&](std::size_t index) { of_cell_.items[next[index]++] = t; });
}

void TriangleSurface::near(const Vector3<>& centre, double reach, std::vector<std::uint32_t>& found) const {
    found.clear();
    const Vector3<> half{reach, reach, reach}, low = centre - half, high = centre + half;
    const auto apart = [&](const Vector3<>& from, const Vector3<>& to) {
        return to.x < low.x || from.x > high.x || to.y < low.y || from.y > high.y || to.z < low.z ||
               from.z > high.z;
    };
    if (apart(lower_, upper_)) return;
    for_each_cell(low, high, [&](std::size_t cell, const Vector3<>&) {
        for (const std::uint32_t t : of_cell_[cell]) {
            const TriangleMesh::Triangle& corners = mesh_.triangles[t];
            const Vector3<>&a = mesh_.vertices[corners[0]], &b = mesh_.vertices[corners[1]],
                  &c = mesh_.vertices[corners[2]];
            if (apart(least(a, least(b, c)), greatest(a, greatest(b, c)))) continue;
            if (std::abs(dot(centre - a, normals_[t])) < reach) found.push_back(t);
        }
    });
    std::ranges::sort(found);
    found.erase(std::unique(found.begin(), found.end()), found.end());
}

/// C. Ericson, Real-Time Collision Detection (2005), sec. 5.1.5.
TriangleSurface::Nearest TriangleSurface::nearest_on(std::uint32_t triangle, const Vector3<>& centre) const {
    const TriangleMesh::Triangle& corners = mesh_.triangles[triangle];
    const std::array<Vector3<>, 3> to{centre - mesh_.vertices[corners[0]],
                                      centre - mesh_.vertices[corners[1]],
                                      centre - mesh_.vertices[corners[2]]};
    const Vector3<> ab = mesh_.vertices[corners[1]] - mesh_.vertices[corners[0]],
                    ac = mesh_.vertices[corners[2]] - mesh_.vertices[corners[0]];
    const auto at = [&](Feature feature, std::uint32_t index, const Vector3<>& arm) {
        return Nearest{triangle, index, feature, norm(arm), arm};
    };
    const auto vertex = [&](std::size_t k) { return at(Feature::vertex, corners[k], to[k]); };
    // From the end of lower index, so that both triangles of an edge find the same point.
    const auto edge = [&](std::size_t k) {
        const std::uint32_t index = edges_[triangle][k];
        const Vector3<>&from = mesh_.vertices[ends_[index][0]],
              along = mesh_.vertices[ends_[index][1]] - from;
        const Vector3<> arm = centre - from;
        return at(Feature::edge, index, arm - (dot(arm, along) / dot(along, along)) * along);
    };
    const double d1 = dot(ab, to[0]), d2 = dot(ac, to[0]);
    if (d1 <= 0 && d2 <= 0) return vertex(0);
    const double d3 = dot(ab, to[1]), d4 = dot(ac, to[1]);
    if (d3 >= 0 && d4 <= d3) return vertex(1);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return edge(0);
    const double d5 = dot(ab, to[2]), d6 = dot(ac, to[2]);
    if (d6 >= 0 && d5 <= d6) return vertex(2);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return edge(2);
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return edge(1);
    const double height = dot(to[0], normals_[triangle]);
    return {triangle, triangle, Feature::face, std::abs(height), height * normals_[triangle]};
}

bool TriangleSurface::is_contact(const Nearest& candidate, std::span<const Nearest> all) const {
    if (candidate.feature == Feature::face) return true;
    const bool is_vertex = candidate.feature == Feature::vertex;
    for (const std::uint32_t t :
         is_vertex ? of_vertex_[candidate.feature_index] : of_edge_[candidate.feature_index]) {
        const auto other = std::ranges::lower_bound(all, t, {}, &Nearest::triangle);
        if (other == all.end() || other->triangle != t) continue;
        if (other->feature == Feature::face) return false;
        if (other->distance < candidate.distance * (1 - same_distance)) return false;
        const bool same =
            other->feature == candidate.feature && other->feature_index == candidate.feature_index;
        if (same && t < candidate.triangle) return false;  // it is told of there
        // The same point, taken for one of an edge that ends there.
        if (is_vertex && other->feature == Feature::edge &&
            other->distance <= candidate.distance * (1 + same_distance) &&
            std::ranges::count(ends_[other->feature_index], candidate.feature_index) > 0 &&
            is_contact(*other, all))
            return false;
    }
    return true;
}

void TriangleSurface::find_contacts(std::span<const std::uint32_t> triangles, const Vector3<>& centre,
                                    double reach, std::vector<Nearest>& nearest,
                                    std::vector<SurfaceContact>& contacts) const {
    nearest.clear();
    for (const std::uint32_t t : triangles) {
        if (!(std::abs(dot(centre - mesh_.vertices[mesh_.triangles[t][0]], normals_[t])) < reach)) continue;
        const Nearest candidate = nearest_on(t, centre);
        if (candidate.distance < reach) nearest.push_back(candidate);
    }
    const std::size_t begin = contacts.size();
    for (const Nearest& candidate : nearest) {
        if (!is_contact(candidate, nearest)) continue;
        const Vector3<>& face = normals_[candidate.triangle];
        Vector3<> normal = face;  // what a centre on the sheet is given, and one above a face, exactly
        if (candidate.feature == Feature::face)
            normal = dot(candidate.arm, face) < 0 ? -face : face;
        else if (candidate.distance > 0)
            normal = (1 / candidate.distance) * candidate.arm;
        contacts.push_back({normal, candidate.distance, part_[candidate.triangle]});
    }
    unite_smooth_contacts(contacts, begin);
}

}  // namespace talus::dem
