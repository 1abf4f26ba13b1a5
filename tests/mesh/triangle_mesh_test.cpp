#include "kinequad/mesh/triangle_mesh.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/shapes.h"

namespace kinequad {
namespace {

TEST(TriangleMesh, BoundingBoxDiagonal) {
    EXPECT_EQ(bounding_box_diagonal(Positions(0, 3)), 0);
    EXPECT_DOUBLE_EQ(bounding_box_diagonal(test::cube(2).V), 2 * std::sqrt(3.0));
}

TEST(TriangleMesh, SurfacePointAtACornerIsThatVertex) {
    const TriangleMesh mesh = test::sphere(1);
    for (int t = 0; t < mesh.F.rows(); ++t) {
        for (int k = 0; k < 3; ++k) {
            SurfacePoint point{t, Vector3::Unit(k)};
            const Vector3 expected = mesh.V.row(mesh.F(t, k));
            EXPECT_EQ(position_of(point, mesh.V, mesh.F), expected);
        }
    }
}

TEST(TriangleMesh, SurfacePointInsideIsTheWeightedMeanOfTheCorners) {
    const TriangleMesh mesh = test::square(1);
    const SurfacePoint point{0, Vector3(0.5, 0.25, 0.25)};
    EXPECT_TRUE(position_of(point, mesh.V, mesh.F).isApprox(Vector3(0.5, 0.25, 0), 1e-15));
}

TEST(TriangleMesh, CentreAndAreaVectorOfATriangle) {
    TriangleMesh mesh;
    mesh.V.resize(4, 3);
    mesh.V << 9, 9, 9, 1, 2, 3, 4, 2, 3, 1, 4, 3;
    mesh.F.resize(2, 3);
    mesh.F << 0, 1, 2, 1, 2, 3;
    EXPECT_TRUE(triangle_centre(mesh.V, mesh.F, 1).isApprox(Vector3(2, 8.0 / 3, 3), 1e-15));
    // Legs of 3 and 2 in z = 3, counter-clockwise seen from above.
    EXPECT_EQ(triangle_area_vector(mesh.V, mesh.F, 1), Vector3(0, 0, 6));
    mesh.F.row(1) << 2, 1, 3;
    EXPECT_EQ(triangle_area_vector(mesh.V, mesh.F, 1), Vector3(0, 0, -6));
}

TEST(TriangleMesh, AreaVectorsOfAClosedSurfaceSumToZeroAndToTwiceItsArea) {
    const TriangleMesh mesh = test::cube(3);
    Vector3 sum = Vector3::Zero();
    double area = 0;
    for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
        const Vector3 across = triangle_area_vector(mesh.V, mesh.F, t);
        EXPECT_GT(across.dot(triangle_centre(mesh.V, mesh.F, t)), 0) << "points outwards";
        sum += across;
        area += across.norm() / 2;
    }
    EXPECT_LT(sum.norm(), 1e-12);
    EXPECT_NEAR(area, 24, 1e-12);
}

}  // namespace
}  // namespace kinequad
