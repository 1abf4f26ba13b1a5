#include "kinequad/measure/quad_shape.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "quad_grid.h"

namespace kinequad {
namespace {

using test::degree;

QuadShapeMetrics measure_one(const std::vector<Vector3>& corners) {
    Positions V(4, 3);
    for (int k = 0; k < 4; ++k) V.row(k) = corners[static_cast<std::size_t>(k)].transpose();
    Quads Q(1, 4);
    Q << 0, 1, 2, 3;
    return measure_shape(V, Q);
}

TEST(QuadShape, IsPerfectForSquares) {
    const test::QuadGrid grid = test::quad_grid(5);
    const QuadShapeMetrics m = measure_shape(grid.X, grid.Q);
    EXPECT_NEAR(m.angle_deviation_mean, 0, 1e-12);
    EXPECT_NEAR(m.angle_deviation_max, 0, 1e-12);
    EXPECT_NEAR(m.scaled_jacobian_min, 1, 1e-14);
    EXPECT_NEAR(m.scaled_jacobian_mean, 1, 1e-14);
    EXPECT_EQ(m.folded_quads, 0);
}

TEST(QuadShape, KnowsTheRhombus) {
    for (const double angle : {20.0, 60.0, 100.0}) {
        const Vector3 u(1, 0, 0);
        const Vector3 v(std::cos(angle * degree), std::sin(angle * degree), 0);
        const QuadShapeMetrics m = measure_one({{0, 0, 0}, u, u + v, v});
        EXPECT_NEAR(m.angle_deviation_mean, std::abs(90 - angle), 1e-12);
        EXPECT_NEAR(m.angle_deviation_max, std::abs(90 - angle), 1e-12);
        EXPECT_NEAR(m.scaled_jacobian_min, std::sin(angle * degree), 1e-14);
    }
}

TEST(QuadShape, KnowsTheTrapezoid) {
    // Corners of 45, 45, 135 and 135 degrees.
    const QuadShapeMetrics m = measure_one({{0, 0, 0}, {3, 0, 0}, {2, 1, 0}, {1, 1, 0}});
    EXPECT_NEAR(m.angle_deviation_mean, 45, 1e-12);
    EXPECT_NEAR(m.scaled_jacobian_min, std::sqrt(0.5), 1e-14);
}

TEST(QuadShape, FindsFoldedQuads) {
    const QuadShapeMetrics arrow = measure_one({{0, 0, 0}, {2, 0, 0}, {0.5, 0.5, 0}, {0, 2, 0}});
    EXPECT_EQ(arrow.folded_quads, 1);
    // The reflex corner at (0.5, 0.5) between directions (3, -1) and (-1, 3).
    EXPECT_NEAR(arrow.scaled_jacobian_min, -0.8, 1e-14);
    const QuadShapeMetrics bow_tie = measure_one({{0, 0, 0}, {1, 0.5, 0}, {1, 0, 0}, {0, 1, 0}});
    EXPECT_EQ(bow_tie.folded_quads, 1);
    EXPECT_LT(bow_tie.scaled_jacobian_min, 0);
    const QuadShapeMetrics triangle = measure_one({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}});
    EXPECT_EQ(triangle.folded_quads, 1);
    EXPECT_NEAR(triangle.scaled_jacobian_min, 0, 1e-14);
}

TEST(QuadShape, TakesCollapsedQuadsForFolded) {
    for (const double z : {0.0, 1.0}) {
        const QuadShapeMetrics m = measure_one({{0, 0, 0}, {0, 0, z}, {0, 0, z}, {0, 0, 0}});
        EXPECT_EQ(m.folded_quads, 1);
        EXPECT_EQ(m.scaled_jacobian_min, -1);
        EXPECT_TRUE(std::isfinite(m.angle_deviation_mean));
    }
}

TEST(QuadShape, KnowsABentQuad) {
    // A square bent by 90 degrees along a diagonal: the sides at the two ends of the fold stay at
    // right angles, the other corners become equilateral.
    const QuadShapeMetrics m = measure_one({{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}});
    EXPECT_NEAR(m.angle_deviation_mean, 0, 1e-12);
    const double h = std::sqrt(0.5);
    const QuadShapeMetrics bent = measure_one({{-h, 0, 0}, {0, -h, 0}, {h, 0, 0}, {0, 0, h}});
    EXPECT_NEAR(bent.angle_deviation_mean, (0 + 0 + 30 + 30) / 4.0, 1e-10);
    EXPECT_NEAR(bent.angle_deviation_max, 30, 1e-10);
}

TEST(QuadShape, LeavesOtherFacesOut) {
    Positions V(7, 3);
    V << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 9, 0.1, 0, 0.5, 5, 0, 0.4, 5, 0;
    Polygons faces = make_polygons(Triangles(Triangles::Constant(1, 3, 4)));
    faces.corners = {0, 1, 2, 3, 1, 4, 2, 3, 2, 4, 5, 6};
    faces.offset = {0, 4, 7, 12};
    const QuadShapeMetrics m = measure_shape(V, faces);
    EXPECT_NEAR(m.angle_deviation_max, 0, 1e-12);
    EXPECT_NEAR(m.scaled_jacobian_min, 1, 1e-14);
}

TEST(QuadShape, DoesNotChangeUnderRigidMotionAndScale) {
    test::QuadGrid grid = test::quad_grid(8);
    for (Eigen::Index i = 0; i < grid.X.rows(); ++i) {
        const double x = grid.X(i, 0);
        const double y = grid.X(i, 1);
        grid.X.row(i) << x + 0.05 * std::sin(9 * y), y + 0.06 * std::cos(7 * x),
            std::sin(3 * x * y);
    }
    const QuadShapeMetrics before = measure_shape(grid.X, grid.Q);
    const Eigen::Matrix3d R =
        Eigen::AngleAxisd(0.7, Vector3(1, 2, -1).normalized()).toRotationMatrix();
    Positions moved = 1e-5 * grid.X * R.transpose();
    moved.rowwise() += Eigen::RowVector3d(0.3, -0.1, 0.2);
    const QuadShapeMetrics after = measure_shape(moved, grid.Q);
    EXPECT_NEAR(after.angle_deviation_mean, before.angle_deviation_mean, 1e-7);
    EXPECT_NEAR(after.angle_deviation_max, before.angle_deviation_max, 1e-7);
    EXPECT_NEAR(after.scaled_jacobian_min, before.scaled_jacobian_min, 1e-9);
    EXPECT_NEAR(after.scaled_jacobian_mean, before.scaled_jacobian_mean, 1e-9);
}

}  // namespace
}  // namespace kinequad
