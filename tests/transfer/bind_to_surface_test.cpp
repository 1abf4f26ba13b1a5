#include "kinequad/transfer/bind_to_surface.h"

#include <gtest/gtest.h>

#include "kinequad/transfer/transfer.h"
#include "support/shapes.h"

namespace kinequad {
namespace {

TEST(BindToSurface, KeepsPointsThatLieOnTheSurface) {
    const TriangleMesh torus = test::torus(24, 16);
    Positions centers(torus.F.rows(), 3);
    for (int t = 0; t < torus.F.rows(); ++t) {
        centers.row(t) = (0.5 * torus.V.row(torus.F(t, 0)) + 0.3 * torus.V.row(torus.F(t, 1)) +
                          0.2 * torus.V.row(torus.F(t, 2)));
    }
    const auto bound = bind_to_surface(centers, torus.V, torus.F);
    ASSERT_EQ(bound.size(), static_cast<std::size_t>(torus.F.rows()));
    for (int t = 0; t < torus.F.rows(); ++t) {
        const SurfacePoint& point = bound[static_cast<std::size_t>(t)];
        EXPECT_EQ(point.triangle, t);
        EXPECT_NEAR((point.barycentric - Vector3(0.5, 0.3, 0.2)).norm(), 0, 1e-9);
    }
    EXPECT_NEAR((carried_positions(bound, torus.V, torus.F) - centers).norm(), 0, 1e-12);
}

TEST(BindToSurface, CarriesPointsThroughAnAffineMotion) {
    const TriangleMesh torus = test::torus(24, 16);
    const TriangleMesh coarse = test::torus(8, 6);
    Eigen::Matrix3d A;
    A << 1.2, 0.1, 0, -0.3, 0.9, 0.2, 0.1, 0, 1.5;
    const auto bound = bind_to_surface(coarse.V, torus.V, torus.F);
    const Positions at_rest = carried_positions(bound, torus.V, torus.F);
    const Positions moved = carried_positions(bound, torus.V * A.transpose(), torus.F);
    EXPECT_NEAR((moved - at_rest * A.transpose()).cwiseAbs().maxCoeff(), 0, 1e-12);
}

TEST(BindToSurface, DoesNotDependOnTheNumberOfThreads) {
    const TriangleMesh sphere = test::sphere(4);
    const Positions X = 1.1 * test::sphere(5).V;
    Context one;
    one.threads = 1;
    Context many;
    many.threads = 8;
    const auto a = bind_to_surface(X, sphere.V, sphere.F, one);
    const auto b = bind_to_surface(X, sphere.V, sphere.F, many);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].triangle, b[i].triangle);
        EXPECT_EQ(a[i].barycentric, b[i].barycentric);
    }
}

TEST(QuadPositions, AreTheSameAsCarriedPositions) {
    const TriangleMesh sphere = test::sphere(3);
    QuadMesh quads;
    quads.vertex = bind_to_surface(test::cube(3).V, sphere.V, sphere.F);
    EXPECT_EQ(quad_positions(quads, sphere.V, sphere.F),
              carried_positions(quads.vertex, sphere.V, sphere.F));
}

}  // namespace
}  // namespace kinequad
