#include "support/shapes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "kinequad/mesh/topology.h"

namespace kinequad {
namespace {

/// Volume enclosed by a closed mesh, positive where its triangles are counter-clockwise from
/// outside.
double signed_volume(const TriangleMesh& mesh) {
    double six_volumes = 0;
    for (int t = 0; t < mesh.F.rows(); ++t) {
        const Vector3 a = mesh.V.row(mesh.F(t, 0));
        const Vector3 b = mesh.V.row(mesh.F(t, 1));
        const Vector3 c = mesh.V.row(mesh.F(t, 2));
        six_volumes += a.dot(b.cross(c));
    }
    return six_volumes / 6;
}

TEST(Shapes, ClosedShapesFaceOutwardsAndEncloseTheirVolume) {
    const double pi = std::numbers::pi;
    EXPECT_NEAR(signed_volume(test::tetrahedron()), 8.0 / 3, 1e-12);
    EXPECT_NEAR(signed_volume(test::cube(1)), 8, 1e-12);
    EXPECT_NEAR(signed_volume(test::cube(5)), 8, 1e-12);
    EXPECT_NEAR(signed_volume(test::sphere(5)), 4 * pi / 3, 0.01);
    EXPECT_NEAR(signed_volume(test::torus(128, 64, 1, 0.4)), 2 * pi * pi * 0.16, 0.02);
}

TEST(Shapes, OpenShapesFaceUpwardsAndOutwards) {
    const TriangleMesh square = test::square(3);
    for (int t = 0; t < square.F.rows(); ++t) {
        const Vector3 a = square.V.row(square.F(t, 0));
        const Vector3 b = square.V.row(square.F(t, 1));
        const Vector3 c = square.V.row(square.F(t, 2));
        EXPECT_GT((b - a).cross(c - a).z(), 0);
    }
    const TriangleMesh cylinder = test::cylinder(12, 3);
    for (int t = 0; t < cylinder.F.rows(); ++t) {
        const Vector3 a = cylinder.V.row(cylinder.F(t, 0));
        const Vector3 b = cylinder.V.row(cylinder.F(t, 1));
        const Vector3 c = cylinder.V.row(cylinder.F(t, 2));
        Vector3 outward = a + b + c;
        outward.z() = 0;
        EXPECT_GT((b - a).cross(c - a).dot(outward), 0);
    }
}

struct Expected {
    const char* name;
    TriangleMesh mesh;
    int euler_characteristic;
    int boundary_loops;
};

TEST(Shapes, HaveTheirKnownTopology) {
    const Expected shapes[] = {
        {"tetrahedron", test::tetrahedron(), 2, 0}, {"cube", test::cube(3), 2, 0},
        {"sphere", test::sphere(2), 2, 0},          {"torus", test::torus(12, 7), 0, 0},
        {"square", test::square(4), 1, 1},          {"cylinder", test::cylinder(9, 4), 0, 2},
    };
    for (const Expected& shape : shapes) {
        SCOPED_TRACE(shape.name);
        const Topology topology =
            build_topology(shape.mesh.F, static_cast<int>(shape.mesh.V.rows()));
        const SurfaceCounts counts = count_surface(topology);
        EXPECT_EQ(counts.vertices, shape.mesh.V.rows()) << "an isolated vertex";
        EXPECT_EQ(counts.components, 1);
        EXPECT_EQ(counts.boundary_loops, shape.boundary_loops);
        EXPECT_EQ(counts.euler_characteristic, shape.euler_characteristic);
    }
}

}  // namespace
}  // namespace kinequad
