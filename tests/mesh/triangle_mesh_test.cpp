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

}  // namespace
}  // namespace kinequad
