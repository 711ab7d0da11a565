#include <gtest/gtest.h>

#include <numbers>

#include "domain/random.hpp"
#include "src/setup/contact.hpp"
#include "src/setup/obj_reader.hpp"
#include "src/setup/packing.hpp"
#include "tests/support/surfaces.hpp"

namespace talus::test {
namespace {

using std::numbers::pi;
constexpr RandomStream random_numbers{.seed = 3};

Point random_point(std::uint64_t id, double half_width) {
    Point point{};
    for (std::size_t a = 0; a < 3; ++a)
        point[a] = half_width * (2 * random_numbers.uniform(id, static_cast<std::uint32_t>(a)) - 1);
    return point;
}

/// Winding number as the sum of the solid angles of all triangles: A. van Oosterom, J. Strackee, IEEE Trans.
/// Biomed. Eng. 30 (1983) 125.
double solid_angle_winding(const Polyhedron& surface, const Point& x) {
    double sum = 0;
    for (const auto& [i, j, k] : surface.triangles) {
        const Point a = minus(surface.vertices[i], x), b = minus(surface.vertices[j], x),
                    c = minus(surface.vertices[k], x);
        const double la = norm(a), lb = norm(b), lc = norm(c);
        sum += 2 * std::atan2(dot(a, cross(b, c)),
                              la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
    }
    return sum / (4 * pi);
}

std::string failure_of(const std::string& text) {
    try {
        parse_obj(text);
    } catch (const ShapeError& error) {
        return error.what();
    }
    return "accepted";
}

/// Moments of the points of a packing in a shape, divided by the number expected from the volume.
struct PointMoments {
    double count = 0;
    Point first{};
    std::array<Point, 3> second{};
};
PointMoments moments(const BodyShape& shape, double spacing) {
    PointMoments result;
    for_each_point(shape, lattice_cell(Lattice::close_packed, 3), spacing, 3, [&](const Point& x) {
        const Point arm = minus(x, centre(shape));
        result.count += spacing * spacing * spacing;
        result.first = plus(result.first, times(spacing * spacing * spacing, arm));
        for (std::size_t a = 0; a < 3; ++a)
            result.second[a] = plus(result.second[a], times(spacing * spacing * spacing * arm[a], arm));
    });
    return result;
}

TEST(Rotations, TurnRightHandedOneAfterTheOther) {
    const Point turned = rotation_about(2, pi / 2)({1, 0, 0});
    EXPECT_NEAR(turned[0], 0, 1e-15);
    EXPECT_NEAR(turned[1], 1, 1e-15);
    const Rotation both = rotation_about(0, 0.3).then(rotation_about(1, 0.7));
    const Point x{1, 2, 3}, expected = rotation_about(1, 0.7)(rotation_about(0, 0.3)(x)), found = both(x),
                            back = both.inverse(found);
    for (std::size_t a = 0; a < 3; ++a) {
        EXPECT_NEAR(found[a], expected[a], 1e-14);
        EXPECT_NEAR(back[a], x[a], 1e-14);
    }
}

// Volume 4/3 pi abc, moments V s^2/5 along the axes. A lattice counts points inside to about the square root
// of the number of points of its surface: 60 000 points, 5 000 of them there.
TEST(Ellipsoids, TurnedVolumeAndMoments) {
    const Rotation turn = rotation_about(0, 0.4).then(rotation_about(1, -0.9)).then(rotation_about(2, 1.3));
    const Point axes{3, 2, 1.5};
    const EllipsoidShape shape{{10, -4, 2}, axes, turn};
    const double exact = 4.0 / 3 * pi * axes[0] * axes[1] * axes[2];
    EXPECT_DOUBLE_EQ(volume(shape, 3), exact);
    const PointMoments found = moments(shape, 0.085);
    EXPECT_NEAR(found.count / exact, 1, 1e-3);
    EXPECT_LT(norm(found.first) / exact, 1e-3 * axes[0]);
    for (std::size_t p = 0; p < 3; ++p)
        for (std::size_t q = 0; q < 3; ++q) {
            double expected = 0;
            for (std::size_t k = 0; k < 3; ++k)
                expected += exact / 5 * axes[k] * axes[k] * turn.rows[p][k] * turn.rows[q][k];
            EXPECT_NEAR(found.second[p][q], expected, 3e-3 * exact / 5 * axes[0] * axes[0]);
        }
    const BoxShape around = bounds(shape, 3);
    for (std::size_t a = 0; a < 3; ++a) {  // the outermost point along a lies at R S^2 R^T e_a / extent
        const double extent = around.upper[a] - shape.centre[a];
        Point tip{};
        for (std::size_t k = 0; k < 3; ++k) tip[k] = axes[k] * axes[k] * turn.rows[a][k] / extent;
        EXPECT_TRUE(contains(shape, plus(shape.centre, times(1 - 1e-12, turn(tip))), 3));
        EXPECT_FALSE(contains(shape, plus(shape.centre, times(1 + 1e-12, turn(tip))), 3));
        EXPECT_NEAR(turn(tip)[a], extent, 1e-12);
    }
}

TEST(Ellipsoids, TurnedIn2D) {
    const EllipsoidShape shape{{5, 0, 0}, {3, 1, 1}, rotation_about(2, pi / 2)};
    EXPECT_DOUBLE_EQ(volume(shape, 2), 3 * pi);
    EXPECT_TRUE(contains(shape, {5, 2.9, 0}, 2));
    EXPECT_FALSE(contains(shape, {6.1, 0, 0}, 2));
    EXPECT_NEAR(bounds(shape, 2).upper[1], 3, 1e-15);
    EXPECT_NEAR(bounds(shape, 2).lower[0], 4, 1e-15);
}

TEST(Packings, PointsInsideDoNotDependOnThePlace) {
    const SphereShape here{{}, 1}, there{{1e5 / 3, 7e4 / 9, 0.1}, 1};
    for (const double spacing : {0.1, 0.125, 0.25}) {
        std::size_t count_here = 0, count_there = 0;
        for_each_point(here, lattice_cell(Lattice::cubic, 3), spacing, 3,
                       [&](const Point&) { ++count_here; });
        for_each_point(there, lattice_cell(Lattice::cubic, 3), spacing, 3,
                       [&](const Point&) { ++count_there; });
        EXPECT_EQ(count_here, count_there);
    }
}

// The integrals of a cube and of a regular icosahedron, in any place: V = 5/12 (3 + sqrt 5) e^3.
TEST(Surfaces, IntegralsAreExact) {
    Polyhedron surface = icosphere(0);
    for (Point& vertex : surface.vertices) vertex = plus(vertex, {100, -50, 3});
    const double edge =
        norm(minus(surface.vertices[surface.triangles[0][0]], surface.vertices[surface.triangles[0][1]]));
    const VolumeIntegrals found = integrate(surface);
    const double exact = 5.0 / 12 * (3 + std::sqrt(5.0)) * edge * edge * edge;
    EXPECT_NEAR(found.volume / exact, 1, 1e-12);
    EXPECT_NEAR(found.centroid[0], 100, 1e-11);
    EXPECT_NEAR(found.centroid[1], -50, 1e-11);
    // Of a regular icosahedron: V phi^2 e^2/20 along any axis, by symmetry no products.
    const double moment = exact * std::numbers::phi * std::numbers::phi * edge * edge / 20;
    for (std::size_t p = 0; p < 3; ++p)
        for (std::size_t q = 0; q < 3; ++q)
            EXPECT_NEAR(found.second_moments[p][q], p == q ? moment : 0, 1e-11 * moment);
}

TEST(Surfaces, InsideIsWhereTheSolidAngleIsFull) {
    Polyhedron surface = icosphere(2);
    for (Point& v : surface.vertices)
        v = times(1 + 0.3 * std::sin(5 * v[0]) * std::cos(4 * v[2]), v);  // lumps
    const SurfaceMesh mesh(surface);
    int inside = 0;
    for (std::uint64_t id = 0; id < 3000; ++id) {
        const Point x = random_point(id, 1.3);
        const double winding = solid_angle_winding(surface, x);
        if (std::abs(winding - std::round(winding)) > 1e-9) continue;  // on the surface
        ASSERT_EQ(mesh.winding_number(x), std::lround(winding)) << x[0] << " " << x[1] << " " << x[2];
        inside += winding > 0.5;
    }
    EXPECT_GT(inside, 600);
    EXPECT_LT(inside, 2400);
}

// Lines that run through vertices and along edges, where a count of crossings is often wrong.
TEST(Surfaces, LinesThroughVerticesAndEdges) {
    const Polyhedron surface = icosphere(3);
    const SurfaceMesh mesh(surface);
    std::vector<SurfaceMesh::Crossing> found;
    const auto balance = [&](double y, double z) {
        mesh.crossings(y, z, found);
        int sum = 0;
        for (const SurfaceMesh::Crossing& crossing : found) sum += crossing.sign;
        return sum;
    };
    for (const Point& v : surface.vertices) {
        EXPECT_EQ(balance(v[1], v[2]), 0);
        EXPECT_EQ(balance(v[1], 0), 0);
        EXPECT_EQ(balance(0, v[2]), 0);
        for (const double x : {-0.999, -0.5, 0.0, 0.5, 0.999}) {
            const Point at{x, 0.9 * v[1], 0.9 * v[2]};
            if (norm(at) < 0.98 || norm(at) > 1) {
                EXPECT_EQ(mesh.winding_number(at), norm(at) < 1);
            }
        }
    }
}

// 81 920 triangles, two million points asked; its time is quoted in docs/decisions/008.
TEST(Surfaces, AMillionParticlesFillAFineSurface) {
    const Polyhedron surface = icosphere(6);
    const double exact = integrate(surface).volume, spacing = std::cbrt(exact / 1e6);
    const MeshShape ball{{}, std::make_shared<SurfaceMesh>(surface)};
    double count = 0;
    for_each_point(ball, lattice_cell(Lattice::close_packed, 3), spacing, 3,
                   [&count](const Point&) { ++count; });
    EXPECT_NEAR(count / 1e6, 1, 1e-3);
}

// Two tetrahedra that overlap: inside of both it winds twice and is still inside.
TEST(Surfaces, PartsMayOverlap) {
    Polyhedron two;
    for (const double x : {0.0, 0.2})
        for (const Point& v : {Point{0, 0, 0}, Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}})
            two.vertices.push_back(plus(v, {x, 0, 0}));
    for (const std::uint32_t n : {0U, 4U})
        for (const Polyhedron::Triangle& t : {Polyhedron::Triangle{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}})
            two.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
    const SurfaceMesh mesh(two);
    EXPECT_EQ(mesh.winding_number({0.1, 0.1, 0.1}), 1);
    EXPECT_EQ(mesh.winding_number({0.3, 0.1, 0.1}), 2);
    EXPECT_EQ(mesh.winding_number({0.95, 0.05, 0.05}), 1);
    EXPECT_EQ(mesh.winding_number({1.25, 0.1, 0.1}), 0);
}

TEST(ObjFiles, AreReadWithPolygonsAndTurnedOutward) {
    std::string cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";
    const std::string outward = "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n",
                      inward = "f 2 3 4 1\nf 8 7 6 5\nf 5 6 2 1\nf 6 7 3 2\nf 7 8 4 3\nf 8 5 1 4\n";
    for (const std::string& faces : {outward, inward}) {
        const VolumeIntegrals found = integrate(parse_obj(cube + faces));
        EXPECT_NEAR(found.volume, 1, 1e-15);
        EXPECT_NEAR(found.centroid[2], 0.5, 1e-15);
        EXPECT_NEAR(found.second_moments[0][0], 1.0 / 12, 1e-15);
        EXPECT_NEAR(found.second_moments[0][1], 0, 1e-15);
    }
    const Polyhedron ball = icosphere(2), read = parse_obj(obj_text(ball));
    ASSERT_EQ(read.vertices.size(), ball.vertices.size());
    for (std::size_t k = 0; k < ball.vertices.size(); ++k)  // the library's reading of numbers rounds twice
        EXPECT_LT(norm(minus(read.vertices[k], ball.vertices[k])), 1e-15);
    EXPECT_EQ(read.triangles, ball.triangles);
}

TEST(ObjFiles, VerticesOfEachFaceMayBeItsOwn) {
    const Polyhedron ball = icosphere(1);
    std::string text;
    for (const Polyhedron::Triangle& triangle : ball.triangles)
        for (const std::uint32_t k : triangle)
            text += "v " + std::to_string(ball.vertices[k][0]) + " " + std::to_string(ball.vertices[k][1]) +
                    " " + std::to_string(ball.vertices[k][2]) + "\n";
    for (std::size_t t = 0; t < ball.triangles.size(); ++t) text += "f -1 -2 -3\n";
    EXPECT_NE(failure_of(text), "accepted") << "all faces are the last three vertices";
    std::string faces;
    for (std::size_t t = 0; t < ball.triangles.size(); ++t)
        faces += "f " + std::to_string(3 * t + 1) + " " + std::to_string(3 * t + 2) + " " +
                 std::to_string(3 * t + 3) + "\n";
    const std::string vertices = text.substr(0, text.find('f'));
    EXPECT_EQ(parse_obj(vertices + faces).vertices.size(), ball.vertices.size());
}

TEST(ObjFiles, WhatCannotBeUsedIsSaid) {
    Polyhedron open = icosphere(1);
    open.triangles.pop_back();
    EXPECT_EQ(failure_of(obj_text(open)).substr(0, 46), "is not closed: 3 of 120 edges are open, the fi");
    Polyhedron turned = icosphere(1);
    std::swap(turned.triangles[7][0], turned.triangles[7][1]);
    EXPECT_EQ(failure_of(obj_text(turned)).substr(0, 54),
              "has faces of opposite orientation at 3 of 120 edges, t");
    EXPECT_EQ(failure_of("v 0 0 0\n"), "has no faces");
    EXPECT_EQ(failure_of(""), "has no faces");
    EXPECT_EQ(failure_of("# x\nv 0 0\nv 1 0 0\n"), "line 2: 'v 0 0' is not a vertex of three numbers");
    EXPECT_EQ(failure_of("v 0 0 x\n"), "line 1: 'v 0 0 x' is not a vertex of three numbers");
    EXPECT_NE(failure_of(obj_text(icosphere(0)) + "f 1 2 77\n"), "accepted");
}

TEST(ContactDistances, OfEllipsoidsAndSurfaces) {
    const SphereShape ball{{5, 5, 5}, 2};
    const EllipsoidShape cigar{{}, {3, 1, 1}, rotation_about(2, pi / 2)};  // long along y
    EXPECT_NEAR(*contact_distance(ball, SphereShape{{}, 1}, {1, 0, 0}, {}, 3), 3, 1e-15);
    EXPECT_NEAR(*contact_distance(ball, SphereShape{{}, 1}, {1, 0, 0}, {0, 1.8, 0}, 3), 2.4, 1e-15);
    EXPECT_FALSE(contact_distance(ball, SphereShape{{}, 1}, {1, 0, 0}, {0, 3.01, 0}, 3));
    EXPECT_NEAR(*contact_distance(ball, cigar, {0, 1, 0}, {}, 3), 5, 1e-6);
    EXPECT_NEAR(*contact_distance(ball, cigar, {1, 0, 0}, {}, 3), 3, 1e-6);
    EXPECT_NEAR(*contact_distance(cigar, ball, {0, 0, 1}, {}, 3), 3, 1e-6);
    EXPECT_FALSE(contact_distance(ball, cigar, {1, 0, 0}, {0, 5.01, 0}, 3));
    // A fine icosphere is a ball to 1 - cos of half the angle between its vertices.
    Polyhedron fine = icosphere(4);
    const MeshShape mesh{{1, 2, 3}, std::make_shared<SurfaceMesh>(fine)};
    const Point skew{2.0 / 3, 2.0 / 3, 1.0 / 3}, aside{0, 0.5, -1};
    EXPECT_NEAR(*contact_distance(ball, mesh, skew, {}, 3), 3, 2e-3);
    EXPECT_NEAR(*contact_distance(mesh, ball, skew, aside, 3), std::sqrt(9 - dot(aside, aside)), 2e-3);
    EXPECT_NEAR(*contact_distance(BoxShape{{-1, -1, -1}, {1, 1, 1}}, ball, {0, 1, 0}, {}, 3), 3, 1e-6);
}

}  // namespace
}  // namespace talus::test
