#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "physics/dem/walls/wall.hpp"
#include "tests/support/grain_collision.hpp"
#include "tests/support/surfaces.hpp"
#include "tests/support/wall_touch.hpp"

namespace talus::dem {
namespace {

constexpr double pi = std::numbers::pi, smooth = pi / 6;

std::vector<SurfaceContact> touch(const TriangleSurface& surface, const Vector3<>& centre, double reach) {
    std::vector<std::uint32_t> triangles;
    std::vector<SurfaceContact> contacts;
    surface.near(centre, reach, triangles);
    std::vector<TriangleSurface::Nearest> nearest;
    surface.find_contacts(triangles, centre, reach, nearest, contacts);
    return contacts;
}
/// An irregular net of 2 n^2 triangles over the square of half side `half`: at (x, y), as `place` says.
template <class Place>
TriangleMesh net(int n, double half, double irregularity, Place&& place) {
    RandomValues random(3);
    TriangleMesh mesh;
    const auto side = static_cast<std::uint32_t>(n + 1);
    for (std::uint32_t j = 0; j < side; ++j)
        for (std::uint32_t i = 0; i < side; ++i) {
            const double step = 2 * half / n, shift = irregularity * step;
            mesh.vertices.push_back(
                place(-half + i * step + random(-shift, shift), -half + j * step + random(-shift, shift)));
        }
    for (std::uint32_t j = 0; j + 1 < side; ++j)
        for (std::uint32_t i = 0; i + 1 < side; ++i) {
            const std::uint32_t a = j * side + i, b = a + 1, c = a + side, d = c + 1;
            if ((i + j) % 2 == 0) {
                mesh.triangles.push_back({a, b, d});
                mesh.triangles.push_back({d, c, a});  // as well as it may run
            } else {
                mesh.triangles.push_back({a, b, c});
                mesh.triangles.push_back({c, b, d});
            }
        }
    return mesh;
}

TriangleMesh cube(double half) {
    TriangleMesh mesh;
    for (int corner = 0; corner < 8; ++corner)
        mesh.vertices.push_back(
            {(corner & 1) ? half : -half, (corner & 2) ? half : -half, (corner & 4) ? half : -half});
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

TriangleMesh ball_mesh(int cuts) {
    const Polyhedron ball = test::icosphere(cuts);
    TriangleMesh mesh;
    for (const auto& v : ball.vertices) mesh.vertices.push_back({v[0], v[1], v[2]});
    mesh.triangles = ball.triangles;
    return mesh;
}

TEST(TriangleSheets, TiledPlaneIsTouchedLikeAPlane) {
    const Vector3<> normal{0.48, -0.6, 0.64}, u{0.8, 0, -0.6}, v = cross(normal, u);
    const TriangleSurface tiles(net(9, 1, 0.3, [&](double x, double y) { return x * u + y * v; }), smooth,
                                0.1);
    EXPECT_EQ(tiles.part_count(), 1);
    RandomValues random(3);
    const auto expect_plane = [&](const Vector3<>& foot) {
        const double height = random(0.01, 0.1) * (random(-1, 1) > 0 ? 1 : -1);
        const auto contacts = touch(tiles, foot + height * normal, 0.11);
        ASSERT_EQ(contacts.size(), 1);
        EXPECT_NEAR(contacts[0].distance, std::abs(height), 4e-16);
        expect_near(contacts[0].normal, (height > 0 ? 1.0 : -1.0) * normal, 2e-14);
        EXPECT_EQ(contacts[0].place, 0);
    };
    for (int sample = 0; sample < 2000; ++sample) expect_plane(random(-0.8, 0.8) * u + random(-0.8, 0.8) * v);
    for (const TriangleMesh::Triangle& t :
         tiles.mesh().triangles)  // at vertices and on edges, as far as it can be
        for (std::size_t k = 0; k < 3; ++k) {
            const Vector3<>&a = tiles.mesh().vertices[t[k]], &b = tiles.mesh().vertices[t[(k + 1) % 3]];
            if (std::max(std::abs(dot(a, u)), std::abs(dot(a, v))) > 0.9) continue;
            expect_plane(a);
            expect_plane(a + random(0, 0.9) * (b - a));
        }
}

template <class Law>
Ball roll_over(const Wall& wall, const Law& law, Ball ball, int steps, double dt, const Vector3<>& gravity) {
    typename Law::History history{};
    ContactLoad<double> load{};
    Vector3<> torque{};
    std::vector<WallContact> contacts;
    for (int step = 0; step < steps; ++step) {
        ball.kick(load.force + ball.mass * gravity, torque, dt / 2);
        ball.drift(dt);
        find_wall_contacts(wall, wall.motion.pose((step + 1) * dt), ball.position, ball.radius, 0, contacts);
        EXPECT_LE(contacts.size(), 1);
        load = {};
        torque = {};
        if (contacts.empty()) {
            history = {};
        } else {
            const WallContact& c = contacts.front();
            load = law(wall_kinematics<double>(c.normal, c.overlap, ball, c.wall_velocity, {}, dt), history);
            torque = torque_about_centre(c.normal, contact_arm(ball.radius, c.overlap), load);
        }
        ball.kick(load.force + ball.mass * gravity, torque, dt / 2);
    }
    return ball;
}

WithFriction<HertzMindlin<double>> soft_law(double friction) {
    return {hertz_mindlin(with_rigid_plane(1e6, 0.3, 0.5, friction), EndOfContact::cut_at_zero),
            {friction},
            {},
            {},
            {}};
}

TEST(TriangleSheets, BallRollsOverTilesAsOverOnePlane) {
    const auto flat = [](double x, double y) { return Vector3<>{x, y, 0}; };
    const Wall tiles{
        "tiles", 0, std::make_shared<const TriangleSurface>(net(40, 0.5, 0.3, flat), smooth, 0.01), {}};
    const Wall plane{"plane", 0, PlaneShape{{0, 0, 0}, {0, 0, 1}}, {}};
    Ball ball = make_ball(0.01, 2500);
    ball.position = {-0.4, -0.31, 0.0102};  // some forty tiles
    ball.velocity = {1, 0.7, 0};
    const Vector3<> gravity{0, 0, -9.81};
    const Ball one = roll_over(plane, soft_law(0.5), ball, 80000, 1e-5, gravity);
    const Ball other = roll_over(tiles, soft_law(0.5), ball, 80000, 1e-5, gravity);
    EXPECT_GT(one.position.x, 0.1);
    expect_near(other.position, one.position, 1e-14);
    expect_near(other.velocity, one.velocity, 1e-13);
    expect_near(other.angular_velocity, one.angular_velocity, 1e-11);
}

TEST(TriangleSheets, OverAConvexEdgeTheContactChangesContinuously) {
    // A ridge, sharp or flat; the ball goes over it at constant height.
    for (const double slope : {0.1, 0.6, 3.0}) {
        const TriangleSurface ridge(net(10, 1, 0,
                                        [&](double x, double y) {
                                            return Vector3<>{x, y, -slope * std::abs(x)};
                                        }),
                                    0.05, 0.2);
        EXPECT_EQ(ridge.part_count(), 2);
        const double step = 1e-4, reach = 0.2;
        SurfaceContact before{};
        for (int k = -1000; k <= 1000; ++k) {
            const auto contacts = touch(ridge, {k * step, 0.123, 0.1}, reach);
            if (contacts.empty()) continue;
            ASSERT_EQ(contacts.size(), 1) << k;
            if (norm(before.normal) > 0) {
                EXPECT_LE(std::abs(contacts[0].distance - before.distance), 1.0001 * step);
                expect_near(contacts[0].normal, before.normal, 1.01 * step / 0.1);
            }
            before = contacts[0];
        }
    }
}

TEST(TriangleSheets, ConcaveCornersAreTouchedByEachFace) {
    const TriangleSurface box(cube(1), smooth, 0.2);
    EXPECT_EQ(box.part_count(), 6);
    RandomValues random(3);
    for (int sample = 0; sample < 2000; ++sample) {  // inside: the faces, as of a container
        const Vector3<> centre = random.vector(0.999);
        auto contacts = touch(box, centre, 0.25),
             expected = touch(ContainerShape{{-1, -1, -1}, {1, 1, 1}}, centre, 0.25);
        ASSERT_EQ(contacts.size(), expected.size());
        for (const SurfaceContact& e : expected)
            EXPECT_TRUE(std::ranges::any_of(contacts, [&](const SurfaceContact& c) {
                return std::abs(c.distance - e.distance) < 1e-15 && norm(c.normal - e.normal) < 1e-15;
            }));
    }
    EXPECT_EQ(touch(box, {0.9, 0.85, 0}, 0.2).size(), 2);
    EXPECT_EQ(touch(box, {0.9, 0.85, -0.95}, 0.2).size(), 3);
}

TEST(TriangleSheets, ConvexEdgesAndCornersAreTouchedOnce) {
    const TriangleSurface box(cube(1), smooth, 0.2);
    const BlockShape block{{-1, -1, -1}, {1, 1, 1}};
    RandomValues random(3);
    int touching = 0;
    for (int sample = 0; sample < 20000; ++sample) {
        const Vector3<> centre = random.vector(1.3);
        if (std::max({std::abs(centre.x), std::abs(centre.y), std::abs(centre.z)}) < 1) continue;
        const auto contacts = touch(box, centre, 0.25), expected = touch(block, centre, 0.25);
        ASSERT_EQ(contacts.size(), expected.size());
        if (expected.empty()) continue;
        ++touching;
        EXPECT_NEAR(contacts[0].distance, expected[0].distance, 1e-15);
        expect_near(contacts[0].normal, expected[0].normal, 1e-13);
    }
    EXPECT_GT(touching, 3000);
    // Exactly where faces, edges and vertices meet.
    for (const double x : {1.0, 1.1})
        for (const double y : {0.5, 1.0, 1.1})
            for (const double z : {0.0, 1.0, 1.1}) {
                const auto contacts = touch(box, {x, y, z}, 0.25), expected = touch(block, {x, y, z}, 0.25);
                ASSERT_EQ(contacts.size(), 1);
                if (expected[0].distance > 0) expect_near(contacts[0].normal, expected[0].normal, 1e-15);
            }
}

TEST(TriangleSheets, BallIsTouchedOnceFromOutsideAndFromInside) {
    const TriangleSurface ball(ball_mesh(3), smooth, 0.1);
    EXPECT_EQ(ball.part_count(), 1);
    RandomValues random(3);
    for (int sample = 0; sample < 3000; ++sample) {
        Vector3<> direction = random.vector(1);
        direction = (1 / norm(direction)) * direction;
        const double sagitta = 0.006;  // of 1280 triangles
        for (const double radius : {1.05, 0.93}) {
            const auto contacts = touch(ball, radius * direction, 0.1);
            ASSERT_EQ(contacts.size(), 1);
            EXPECT_NEAR(contacts[0].distance, std::abs(radius - 1), sagitta);
            EXPECT_GT(dot(contacts[0].normal, radius > 1 ? direction : -direction), 0.99);
        }
    }
}

TEST(TriangleSheets, NearFindsAllTriangles) {
    TriangleMesh mesh = ball_mesh(2);
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(),
                         {{-3, -3, -1.2}, {3, -3, -1.2}, {0, 4, -1.3}});  // one far larger
    mesh.triangles.push_back({base, base + 1, base + 2});
    for (const double usual_reach : {0.01, 0.2, 2.0}) {
        const TriangleSurface surface(mesh, smooth, usual_reach);
        RandomValues random(3);
        std::vector<std::uint32_t> found, all(mesh.triangles.size());
        for (std::uint32_t t = 0; t < all.size(); ++t) all[t] = t;
        for (int sample = 0; sample < 500; ++sample) {
            const Vector3<> centre = random.vector(1.5);
            const double reach = random(0.01, 0.5);
            surface.near(centre, reach, found);
            EXPECT_TRUE(std::ranges::is_sorted(found));
            std::vector<SurfaceContact> by_cells, by_force;
            std::vector<TriangleSurface::Nearest> nearest;
            surface.find_contacts(found, centre, reach, nearest, by_cells);
            surface.find_contacts(all, centre, reach, nearest, by_force);
            ASSERT_EQ(by_cells.size(), by_force.size());
            for (std::size_t k = 0; k < by_cells.size(); ++k) {
                EXPECT_EQ(by_cells[k].distance, by_force[k].distance);
                EXPECT_EQ(by_cells[k].normal, by_force[k].normal);
                EXPECT_EQ(by_cells[k].place, by_force[k].place);
            }
        }
    }
}

TEST(TriangleSheets, FacettedHollowIsTouchedOnceAndContinuously) {
    // A tube of 24 facets, and one of a smoother profile that it stands for.
    const int facets = 24;
    TriangleMesh tube;
    for (int k = 0; k < facets; ++k)
        for (const double z : {-1.0, 1.0})
            tube.vertices.push_back({std::cos(2 * pi * k / facets), std::sin(2 * pi * k / facets), z});
    for (std::uint32_t k = 0; k < 2 * facets; k += 2) {
        const std::uint32_t a = k, b = k + 1, c = (k + 2) % (2 * facets), d = (k + 3) % (2 * facets);
        tube.triangles.push_back({a, c, b});
        tube.triangles.push_back({b, c, d});
    }
    const TriangleSurface surface(tube, smooth, 0.3);
    EXPECT_EQ(surface.part_count(), 1);
    SurfaceContact before{};
    const double radius = 0.75, reach = 0.3, step = 1e-4;
    for (double angle = 0; angle < 1; angle += step) {
        const auto contacts =
            touch(surface, {radius * std::cos(angle), radius * std::sin(angle), 0.01}, reach);
        ASSERT_EQ(contacts.size(), 1);
        EXPECT_NEAR(contacts[0].distance, 1 - radius, 1 - std::cos(pi / facets) + 1e-9);
        if (angle > 0) {
            EXPECT_LE(std::abs(contacts[0].distance - before.distance), 2 * step);
            expect_near(contacts[0].normal, before.normal, 30 * step);
        }
        before = contacts[0];
    }
}

TEST(TriangleSheets, DefectsAreCounted) {
    TriangleMesh mesh = cube(1);
    EXPECT_EQ(
        find_defects(mesh).open_edges + find_defects(mesh).without_area + find_defects(mesh).crowded_edges,
        0);
    mesh.triangles.pop_back();
    mesh.triangles.push_back({0, 1, 1});
    mesh.vertices.push_back({0, -1, -1});  // in the middle of the edge 0-1
    mesh.triangles.push_back({0, 8, 1});
    const MeshDefects defects = find_defects(mesh);
    EXPECT_EQ(defects.without_area, 2);
    EXPECT_EQ(defects.open_edges, 3);
    remove_triangles_without_area(mesh);
    EXPECT_EQ(mesh.triangles.size(), 11);
}

}  // namespace
}  // namespace talus::dem
