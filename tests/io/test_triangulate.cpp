#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>

#include "io_support.h"
#include "kinequad/io/triangulate_polygons.h"

namespace kinequad::test {
namespace {

double area_in_plane(const Positions& V, const Triangles& F, Eigen::Index t) {
    const Eigen::Vector2d a = V.row(F(t, 0)).head<2>();
    const Eigen::Vector2d b = V.row(F(t, 1)).head<2>();
    const Eigen::Vector2d c = V.row(F(t, 2)).head<2>();
    return ((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x()) / 2;
}

TEST(TriangulatePolygons, CutsAQuadAlongItsShorterDiagonal) {
    const Positions V = positions_of({{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {1, 1, 0}});
    Triangles expected(2, 3);
    expected << 0, 1, 3, 1, 2, 3;
    EXPECT_EQ(triangulate_polygons(V, polygons_of({{0, 1, 2, 3}})), expected);
}

TEST(TriangulatePolygons, AvoidsTrianglesWithoutArea) {
    // Corner 1 lies on the line from 0 to 2: the shorter diagonal would leave 0, 1, 2 without area.
    const Positions V = positions_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 3, 0}});
    const Triangles F = triangulate_polygons(V, polygons_of({{0, 1, 2, 3}}));
    for (Eigen::Index t = 0; t < 2; ++t) EXPECT_GT(area_in_plane(V, F, t), 0.1);
}

TEST(TriangulatePolygons, CutsAConcaveQuadAtItsReflexCorner) {
    const Positions V = positions_of({{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}});
    for (int first = 0; first < 4; ++first) {
        std::vector<int> quad;
        for (int k = 0; k < 4; ++k) quad.push_back((first + k) % 4);
        const Triangles F = triangulate_polygons(V, polygons_of({quad}));
        for (Eigen::Index t = 0; t < 2; ++t) EXPECT_GT(area_in_plane(V, F, t), 0);
    }
}

TEST(TriangulatePolygons, PassesOnTrianglesAndFacesWithoutArea) {
    const Positions V = positions_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    Triangles expected(3, 3);
    expected << 2, 1, 0, 0, 0, 1, 0, 1, 0;
    EXPECT_EQ(triangulate_polygons(V, polygons_of({{2, 1, 0}, {0, 0, 1}, {0, 1, 0}})), expected);
    EXPECT_EQ(triangulate_polygons(V, polygons_of({{0, 0, 0, 0, 0, 0}})).rows(), 4);
}

TEST(TriangulatePolygons, FansFacesOfVeryManyCorners) {
    std::vector<Vector3> points;
    std::vector<int> face;
    for (int k = 0; k < 1000; ++k) {
        const double angle = 2 * std::numbers::pi * k / 1000;
        points.emplace_back(std::cos(angle), std::sin(angle), 0);
        face.push_back(k);
    }
    const Positions V = positions_of(points);
    const Triangles F = triangulate_polygons(V, polygons_of({face}));
    EXPECT_EQ(F.rows(), 998);
    for (Eigen::Index t = 0; t < F.rows(); ++t) EXPECT_GT(area_in_plane(V, F, t), 0);
}

// A star-shaped polygon about the origin is simple: its triangles must be positive and fill it.
RC_GTEST_PROP(TriangulatePolygons, FillsAnyStarShapedPolygonWithPositiveTriangles, ()) {
    const int n = *rc::gen::inRange(4, 40);
    std::vector<Vector3> points;
    std::vector<int> face;
    double area = 0;
    for (int k = 0; k < n; ++k) {
        const double radius = 0.2 + 0.01 * *rc::gen::inRange(0, 100);
        const double angle = 2 * std::numbers::pi * k / n;
        points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
        face.push_back(k);
    }
    for (int k = 0; k < n; ++k) {
        const Vector3& p = points[static_cast<std::size_t>(k)];
        const Vector3& q = points[static_cast<std::size_t>((k + 1) % n)];
        area += (p.x() * q.y() - p.y() * q.x()) / 2;
    }
    const Positions V = positions_of(points);
    const Triangles F = triangulate_polygons(V, polygons_of({face}));
    RC_ASSERT(F.rows() == n - 2);
    double sum = 0;
    for (Eigen::Index t = 0; t < F.rows(); ++t) {
        RC_ASSERT(area_in_plane(V, F, t) > -1e-12);
        sum += area_in_plane(V, F, t);
    }
    RC_ASSERT(std::abs(sum - area) < 1e-9);
}

}  // namespace
}  // namespace kinequad::test
