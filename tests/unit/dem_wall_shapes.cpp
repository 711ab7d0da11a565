#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "physics/dem/walls/wall.hpp"
#include "tests/support/grain_collision.hpp"
#include "tests/support/wall_touch.hpp"

namespace talus::dem {
namespace {

constexpr double pi = std::numbers::pi, smooth = pi / 6;

void expect_one(const std::vector<SurfaceContact>& contacts, double distance, const Vector3<>& normal) {
    ASSERT_EQ(contacts.size(), 1);
    EXPECT_NEAR(contacts[0].distance, distance, 1e-14);
    expect_near(contacts[0].normal, normal, 1e-14);
}

TEST(WallShapes, PlaneKeepsGrainsInFrontOfIt) {
    const PlaneShape plane{{0, 0, 1}, {0, 0.6, 0.8}};
    expect_one(touch(plane, {5, 0.06, 1.08}, 0.2), 0.1, plane.normal);
    expect_one(touch(plane, {5, -0.06, 0.92}, 0.2), -0.1, plane.normal);
    EXPECT_TRUE(touch(plane, {5, 0.6, 1.8}, 0.2).empty());
}

TEST(WallShapes, BlockPushesOutThroughTheNearestFace) {
    const BlockShape block{{0, 0, 0}, {1, 2, 3}};
    expect_one(touch(block, {0.5, 1.9, 1}, 0.2), -0.1, {0, 1, 0});
    expect_one(touch(block, {1.3, 2.4, 1}, 0.6), 0.5, {0.6, 0.8, 0});
}

TEST(WallShapes, TubeIsTouchedFromWithinAndFromWithout) {
    const Vector3<> axis{0.6, 0, 0.8}, out{0.8, 0, -0.6}, origin{1, 2, 3};
    const RevolvedShape tube(origin, axis, {{0.5, -1}, {0.5, 2}}, smooth);
    expect_one(touch(tube, origin + 0.3 * axis + 0.4 * out, 0.2), 0.1, -out);
    expect_one(touch(tube, origin + 0.3 * axis + 0.65 * out, 0.2), 0.15, out);
    EXPECT_TRUE(touch(tube, origin + 0.3 * axis + 0.2 * out, 0.2).empty());
    EXPECT_TRUE(touch(tube, origin + 2.3 * axis + 0.4 * out, 0.2).empty());
    expect_one(touch(tube, origin + 2.03 * axis + 0.46 * out, 0.2), 0.05, 0.6 * axis - 0.8 * out);  // its rim
    // A ball that fills it is held from both sides, and drawn nowhere in the middle.
    EXPECT_EQ(touch(tube, origin + 0.02 * out, 0.6).size(), 2);
    const auto centred = touch(tube, origin, 0.6);
    ASSERT_EQ(centred.size(), 2);
    expect_near(centred[0].normal, -centred[1].normal, 1e-15);
    EXPECT_NE(centred[0].place, centred[1].place);
}

TEST(WallShapes, DiskAndConeAreRevolvedToo) {
    const RevolvedShape disk({}, {0, 0, 1}, {{0, 0}, {1, 0}}, smooth);
    expect_one(touch(disk, {0.3, 0, 0.1}, 0.2), 0.1, {0, 0, 1});
    expect_one(touch(disk, {0, 0, -0.1}, 0.2), 0.1, {0, 0, -1});
    expect_one(touch(disk, {0.05, 0, 0.1}, 0.2), 0.1, {0, 0, 1});
    expect_one(touch(disk, {1.03, 0, 0.04}, 0.2), 0.05, {0.6, 0, 0.8});
    const RevolvedShape cone({}, {0, 0, 1}, {{0, 0}, {3, 4}}, smooth);  // opens upwards
    expect_one(touch(cone, {1.8 - 0.4, 0, 2.4 + 0.3}, 0.9), 0.5, {-0.8, 0, 0.6});
    expect_one(touch(cone, {1.8 + 0.4, 0, 2.4 - 0.3}, 0.9), 0.5, {0.8, 0, -0.6});
    expect_one(touch(cone, {0, 0, -0.1}, 0.2), 0.1, {0, 0, -1});  // its tip from below
    const auto jammed = touch(cone, {0, 0, 1}, 0.7);
    ASSERT_EQ(jammed.size(), 2);
    expect_near(jammed[0].normal + jammed[1].normal, {0, 0, 1.2}, 1e-14);
    EXPECT_NEAR(jammed[0].distance, 0.6, 1e-14);
}

TEST(WallShapes, SiloIsOneSheetWithoutDoubleContacts) {
    // Tube, hopper of 45 degrees, orifice.
    const RevolvedShape silo({}, {0, 0, 1}, {{0.02, -0.08}, {0.1, 0}, {0.1, 0.3}}, smooth);
    EXPECT_EQ(touch(silo, {0.097, 0, 0.1}, 0.004).size(), 1);
    EXPECT_EQ(touch(silo, {0.097, 0, 0.0013}, 0.004).size(), 2);  // where the hopper begins
    // Over the rim of the orifice: one contact, that changes continuously.
    SurfaceContact before{};
    int touching = 0;
    const double step = 1e-5;
    for (double z = -0.07; z > -0.09; z -= step) {
        const auto contacts = touch(silo, {0.018, 0, z}, 0.005);
        if (contacts.empty()) continue;
        ASSERT_EQ(contacts.size(), 1);
        if (++touching > 1) {
            EXPECT_LE(std::abs(contacts[0].distance - before.distance), 1.001 * step);
            expect_near(contacts[0].normal, before.normal, 1.1 * step / contacts[0].distance);
        }
        before = contacts[0];
    }
    EXPECT_GT(touching, 500);
}

TEST(WallShapes, RevolvedSheetAndItsTrianglesAgree) {
    const std::vector<RevolvedShape::ProfilePoint> profile{{0.02, -0.08}, {0.1, 0}, {0.1, 0.3}};
    const RevolvedShape silo({}, {0, 0, 1}, profile, smooth);
    constexpr std::uint32_t around = 180;
    TriangleMesh mesh;
    for (const auto& p : profile)
        for (std::uint32_t k = 0; k < around; ++k)
            mesh.vertices.push_back({p.radius * std::cos(2 * pi * k / around),
                                     p.radius * std::sin(2 * pi * k / around), p.along});
    for (std::uint32_t ring = 0; ring < 2; ++ring)
        for (std::uint32_t k = 0; k < around; ++k) {
            const std::uint32_t a = ring * around + k, b = ring * around + (k + 1) % around;
            mesh.triangles.push_back({a, b, a + around});
            mesh.triangles.push_back({b, b + around, a + around});
        }
    const TriangleSurface surface(mesh, smooth, 0.01);
    EXPECT_EQ(surface.part_count(), 2);
    RandomValues random(8);
    std::vector<std::uint32_t> triangles;
    int touching = 0;
    const double sagitta = 0.1 * (1 - std::cos(pi / around));  // 1.5e-5
    for (int sample = 0; sample < 20000; ++sample) {
        const Vector3<> centre{random(-0.12, 0.12), random(-0.12, 0.12), random(-0.08, 0.12)};
        const double reach = 0.008;
        auto exact = touch(silo, centre, reach);
        if (exact.size() != 1 || std::abs(exact[0].distance - reach) < 2 * sagitta ||
            exact[0].distance < 1e-4)
            continue;
        std::vector<SurfaceContact> contacts;
        surface.near(centre, reach, triangles);
        std::vector<TriangleSurface::Nearest> room;
        surface.find_contacts(triangles, centre, reach, room, contacts);
        ++touching;
        const auto nearest = std::ranges::min_element(contacts, {}, &SurfaceContact::distance);
        ASSERT_NE(nearest, contacts.end());
        EXPECT_NEAR(nearest->distance, exact[0].distance, 2 * sagitta);
        EXPECT_GT(dot(nearest->normal, exact[0].normal), 0.98);
    }
    EXPECT_GT(touching, 1000);
}

WallMotion some_motion() {
    return {.velocity = {0.1, -0.2, 0.3},
            .amplitude = {0.01, 0.02, 0},
            .translation_oscillation = {.frequency = 3, .phase = 0.4},
            .centre = {1, 0, 0.5},
            .axis = {0.6, 0, 0.8},
            .angular_velocity = 2,
            .angle_amplitude = 0.3,
            .rotation_oscillation = {.frequency = 1.5, .phase = 0},
            .begin = 0.5,
            .end = 2};
}

/// Where a place of the wall at rest is.
Vector3<> carried(const WallPose& pose, const Vector3<>& at_rest) {
    return pose.turned(at_rest - pose.centre) + pose.centre + pose.shift;
}

TEST(WallMotions, VelocitiesAreTheRatesOfChange) {
    const WallMotion motion = some_motion();
    const Vector3<> place{0.3, -0.7, 1.1};
    const double h = 1e-5;
    for (const double time : {0.6, 1.0, 1.7}) {
        const WallPose now = motion.pose(time);
        const Vector3<> rate =
            (1 / (2 * h)) * (carried(motion.pose(time + h), place) - carried(motion.pose(time - h), place));
        expect_near(now.velocity_at(carried(now, place)), rate, 1e-6);
        expect_near(now.in_wall(carried(now, place)), place, 1e-14);
        for (int k = 0; k < 3; ++k)
            for (int l = 0; l < 3; ++l) EXPECT_NEAR(dot(now.rows[k], now.rows[l]), k == l, 1e-15);
    }
    expect_near(carried(motion.pose(0.2), place), place, 1e-15);  // has not set out
    EXPECT_EQ(norm(motion.pose(0.2).velocity), 0);
    expect_near(carried(motion.pose(5), place), carried(motion.pose(2), place), 0);  // has stopped
    EXPECT_EQ(norm(motion.pose(5).angular_velocity), 0);
    // A wall that does not move leaves places as they are, to the bit.
    const Vector3<> odd{0.1, 1.0 / 3, 1e-7};
    EXPECT_EQ(WallMotion{}.pose(3).in_wall(odd), odd);
    EXPECT_EQ(WallMotion{}.pose(3).turned(odd), odd);
}

TEST(WallMotions, DisplacementsAreBounded) {
    const WallMotion motion = some_motion();
    const WallPose from = motion.pose(0.9);
    RandomValues random(2);
    for (int sample = 0; sample < 300; ++sample) {
        const WallPose to = motion.pose(random(0.9, 1.2));
        Vector3<> offset = random.vector(1);
        offset = (0.2 / norm(offset)) * offset;
        const Vector3<> centre{0.5, 1, -0.2}, place = from.in_wall(centre + offset);
        EXPECT_LE(norm(carried(to, place) - carried(from, place)),
                  greatest_displacement(from, to, centre, 0.2) + 1e-15);
    }
}

TEST(WallMotions, TurnedWallIsTouchedWhereItIs) {
    const Wall drum{"drum",
                    0,
                    RevolvedShape({0, 0, 0}, {0, 1, 0}, {{0, -1}, {1, -1}, {1, 1}, {0, 1}}, smooth),
                    {.velocity = {},
                     .amplitude = {},
                     .translation_oscillation = {},
                     .centre = {0, 0, 0},
                     .axis = {0, 1, 0},
                     .angular_velocity = 2,
                     .angle_amplitude = 0,
                     .rotation_oscillation = {}}};
    const WallPose pose = drum.motion.pose(0.7);
    std::vector<WallContact> contacts;
    find_wall_contacts(drum, pose, {0.93, 0, 0}, 0.1, 0, contacts);
    ASSERT_EQ(contacts.size(), 1);  // a surface of revolution that turns is where it was, and moves
    expect_near(contacts[0].normal, {-1, 0, 0}, 1e-15);
    EXPECT_NEAR(contacts[0].overlap, 0.03, 1e-15);
    expect_near(contacts[0].point, {1.015, 0, 0}, 1e-15);
    expect_near(contacts[0].wall_velocity, {0, 0, -2 * 1.015}, 1e-14);
    EXPECT_TRUE(may_touch(drum, pose, {0.85, 0, 0}, 0.1, 0.06));
    EXPECT_FALSE(may_touch(drum, pose, {0.85, 0, 0}, 0.1, 0.04));

    const Wall gate{"gate",
                    0,
                    PlaneShape{{0, 0, 0}, {0, 0, 1}},
                    {.velocity = {},
                     .amplitude = {},
                     .translation_oscillation = {},
                     .centre = {0, 0, 0},
                     .axis = {0, 1, 0},
                     .angular_velocity = pi / 2,
                     .angle_amplitude = 0,
                     .rotation_oscillation = {}}};
    find_wall_contacts(gate, gate.motion.pose(1), {0.05, 3, 7}, 0.1, 0, contacts);
    ASSERT_EQ(contacts.size(), 1);  // +z has become +x
    expect_near(contacts[0].normal, {1, 0, 0}, 1e-15);
    expect_near(contacts[0].wall_velocity, {7 * pi / 2, 0, -contacts[0].point.x * pi / 2}, 1e-13);
}

TEST(WallMotions, CollisionWithAMovingFloorIsThatOfAFloorAtRest) {
    const WithFriction<HertzMindlin<double>> law{
        hertz_mindlin(with_rigid_plane(1e7, 0.3, 0.6, 0.3), EndOfContact::cut_at_zero), {0.3}, {}, {}, {}};
    const auto bounce = [&](const Vector3<>& frame) {
        Wall floor{"floor", 0, PlaneShape{{0, 0, 0}, {0, 0, 1}}, {}};
        floor.motion.velocity = frame;
        Ball ball = make_ball(0.01, 2500);
        ball.position = {0, 0, 0.01};
        ball.velocity = Vector3<>{0.5, 0, -1} + frame;
        std::array<double, 3> history{};
        std::vector<WallContact> contacts;
        const double dt = 1e-6;
        for (int step = 1; step <= 3000; ++step) {
            ball.drift(dt);
            find_wall_contacts(floor, floor.motion.pose(step * dt), ball.position, ball.radius, 0, contacts);
            if (contacts.empty()) continue;
            const WallContact& c = contacts[0];
            const auto load =
                law(wall_kinematics<double>(c.normal, c.overlap, ball, c.wall_velocity, {}, dt), history);
            ball.kick(load.force, torque_about_centre(c.normal, contact_arm(ball.radius, c.overlap), load),
                      dt);
        }
        ball.velocity += -frame;
        return ball;
    };
    const Ball at_rest = bounce({}), moved = bounce({0.3, -0.2, 0.4});
    EXPECT_NEAR(at_rest.velocity.z, 0.6, 0.01);
    expect_near(moved.velocity, at_rest.velocity, 1e-8);
    expect_near(moved.angular_velocity, at_rest.angular_velocity, 1e-6);
}

}  // namespace
}  // namespace talus::dem
