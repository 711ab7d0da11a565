#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "src/setup/wall_mesh_reader.hpp"
#include "tests/support/surfaces.hpp"

namespace talus {
namespace {

void append_float(std::string& bytes, double value) {
    const auto number = static_cast<float>(value);
    char raw[4];
    std::memcpy(raw, &number, 4);
    bytes.append(raw, 4);
}

/// Binary STL: 80 bytes, a count, and 50 bytes a triangle.
std::string binary_stl(const Polyhedron& surface) {
    std::string bytes(80, ' ');
    const auto count = static_cast<std::uint32_t>(surface.triangles.size());
    char raw[4];
    std::memcpy(raw, &count, 4);
    bytes.append(raw, 4);
    for (const Polyhedron::Triangle& triangle : surface.triangles) {
        for (int k = 0; k < 3; ++k) append_float(bytes, 0);
        for (const std::uint32_t corner : triangle)
            for (const double coordinate : surface.vertices[corner]) append_float(bytes, coordinate);
        bytes.append(2, '\0');
    }
    return bytes;
}

std::string text_stl(const Polyhedron& surface) {
    std::string text = "solid ball\n";
    for (const Polyhedron::Triangle& triangle : surface.triangles) {
        text += " facet normal 0 0 0\n  outer loop\n";
        for (const std::uint32_t corner : triangle) {
            text += "   vertex";
            for (const double coordinate : surface.vertices[corner]) text += fmt::format(" {}", coordinate);
            text += "\n";
        }
        text += "  endloop\n endfacet\n";
    }
    text += "endsolid ball\n";
    return text;
}

TEST(WallMeshes, AreReadFromStlAndObj) {
    const Polyhedron ball = test::icosphere(2);
    for (const auto& [name, content] : {std::pair<std::string, std::string>{"ball.stl", binary_stl(ball)},
                                        {"ball.STL", text_stl(ball)},
                                        {"a.b/ball.obj", test::obj_text(ball)}}) {
        const WallMesh read = read_wall_mesh(name, content, 0.5);
        EXPECT_EQ(read.mesh.triangles.size(), ball.triangles.size()) << name;
        EXPECT_EQ(read.mesh.vertices.size(), ball.vertices.size()) << name;
        EXPECT_TRUE(read.warnings.empty()) << name << ": " << read.warnings.front();
        for (const dem::Vector3<>& vertex : read.mesh.vertices) EXPECT_NEAR(norm(vertex), 0.5, 1e-6) << name;
    }
}

TEST(WallMeshes, HolesAndTrianglesWithoutAreaAreWarnedOf) {
    Polyhedron ball = test::icosphere(1);
    ball.triangles.pop_back();
    ball.triangles.push_back({0, 1, 1});
    for (const auto& [name, content] : {std::pair<std::string, std::string>{"ball.stl", binary_stl(ball)},
                                        {"ball.obj", test::obj_text(ball)}}) {
        const WallMesh read = read_wall_mesh(name, content, 1);
        EXPECT_EQ(read.mesh.triangles.size(), 79) << name;
        ASSERT_EQ(read.warnings.size(), 2) << name;
        EXPECT_EQ(read.warnings[0], "1 of 80 triangles have no area and are left out");
        EXPECT_EQ(read.warnings[1].substr(0, 60),
                  "is not closed: 3 edges belong to one triangle only, one of t");
    }
}

TEST(WallMeshes, WhatCannotBeUsedIsRefused) {
    const auto refused = [](const std::string& name, const std::string& content) -> std::string {
        try {
            read_wall_mesh(name, content, 1);
        } catch (const ShapeError& error) {
            return error.what();
        }
        return "accepted";
    };
    const Polyhedron ball = test::icosphere(1);
    EXPECT_EQ(refused("ball.ply", "ply"), "'.ply' is no mesh file that can be read: .stl or .obj");
    EXPECT_NE(refused("ball.stl", binary_stl(ball).substr(0, 900)).find("cannot be read"), std::string::npos);
    EXPECT_NE(refused("ball.stl", "").find("cannot be read"), std::string::npos);
    EXPECT_EQ(refused("ball.obj", "v 0 0 0\n"), "has no triangles");
    EXPECT_EQ(refused("ball.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"),
              "none of its 1 triangles has an area");
    EXPECT_NE(refused("ball.obj", "v 0 0 x\n").find("line 1"), std::string::npos);
    std::string spoilt = binary_stl(ball);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(spoilt.data() + 84 + 12, &nan, 4);
    EXPECT_EQ(refused("ball.stl", spoilt).substr(0, 16), "has a vertex (na");
}

TEST(WallMeshes, OutsideTheBoxIsCounted) {
    const WallMesh ball = read_wall_mesh("ball.stl", binary_stl(test::icosphere(1)), 1);
    Box box;
    box.lower = {-1.1, -1.1, -1.1};
    box.upper = {1.1, 1.1, 0.9};
    EXPECT_EQ(outside_of(ball.mesh, box), "");  // open
    box.boundary = {Boundary::periodic, Boundary::periodic, Boundary::reflecting};
    EXPECT_NE(outside_of(ball.mesh, box).find("of 80 triangles reach outside the box"), std::string::npos);
    box.upper[2] = 1.1;
    EXPECT_EQ(outside_of(ball.mesh, box), "");
}

}  // namespace
}  // namespace talus
