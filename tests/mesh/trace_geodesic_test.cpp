#include "kinequad/mesh/trace_geodesic.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "support/shapes.h"

namespace kinequad {
namespace {

/// A mesh on which straight lines are drawn.
struct Ground {
    TriangleMesh mesh;
    Topology topology;
    IntrinsicMetric metric;

    explicit Ground(TriangleMesh shape)
        : mesh(std::move(shape)),
          topology(build_topology(mesh.F, static_cast<int>(mesh.V.rows()))),
          metric(metric_of(topology, mesh.V)) {}

    Vector3 corner(int t, int k) const { return mesh.V.row(mesh.F(t, k)).transpose(); }

    /// Where the walk from `start` along a vector in space, tangent to the start's triangle, ends.
    Vector3 walk(const SurfacePoint& start, const Vector3& way) const {
        const Vector3 x = (corner(start.triangle, 1) - corner(start.triangle, 0)).normalized();
        const Vector3 normal =
            x.cross(corner(start.triangle, 2) - corner(start.triangle, 0)).normalized();
        const Vector2 direction(way.dot(x), way.dot(normal.cross(x)));
        const SurfacePoint end = trace_geodesic(topology, metric, start, direction);
        EXPECT_NEAR(end.barycentric.sum(), 1, 1e-12);
        EXPECT_GE(end.barycentric.minCoeff(), 0);
        return position_of(end, mesh.V, mesh.F);
    }

    Vector3 position(const SurfacePoint& point) const { return position_of(point, mesh.V, mesh.F); }
};

SurfacePoint random_point(const Ground& ground, std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(0, 1);
    SurfacePoint point;
    point.triangle = static_cast<int>(random() % static_cast<unsigned>(ground.mesh.F.rows()));
    point.barycentric = Vector3(uniform(random), uniform(random), uniform(random));
    point.barycentric /= point.barycentric.sum();
    return point;
}

TEST(TraceGeodesic, IsAStraightLineInThePlane) {
    const Ground ground(test::square(9));
    std::mt19937 random(1);
    for (int run = 0; run < 300; ++run) {
        const SurfacePoint start = random_point(ground, random);
        const Vector3 goal = ground.position(random_point(ground, random));
        const Vector3 end = ground.walk(start, goal - ground.position(start));
        EXPECT_LT((end - goal).norm(), 1e-10);
    }
}

TEST(TraceGeodesic, LeavesVerticesInAnyDirection) {
    const Ground ground(test::square(4));
    for (int t = 0; t < ground.mesh.F.rows(); ++t) {
        for (int k = 0; k < 3; ++k) {
            if (ground.topology.is_boundary_vertex(ground.mesh.F(t, k))) continue;
            const SurfacePoint start{t, Vector3::Unit(k)};
            for (int i = 0; i < 16; ++i) {
                // Some of them along mesh edges.
                const double angle = std::numbers::pi * i / 8;
                const Vector3 way = 0.2 * Vector3(std::cos(angle), std::sin(angle), 0);
                EXPECT_LT((ground.walk(start, way) - ground.position(start) - way).norm(), 1e-10);
            }
        }
    }
}

TEST(TraceGeodesic, StopsAtTheBoundary) {
    const Ground ground(test::square(5));
    std::mt19937 random(2);
    for (int run = 0; run < 100; ++run) {
        const SurfacePoint start = random_point(ground, random);
        const Vector3 from = ground.position(start);
        const double angle = static_cast<double>(run);
        const Vector3 way = 10 * Vector3(std::cos(angle), std::sin(angle), 0);
        const Vector3 end = ground.walk(start, way);
        // On the ray, and on the nearest of the four sides along it.
        double share = 1;
        for (int k = 0; k < 2; ++k) {
            if (way[k] != 0) share = std::min(share, ((way[k] > 0 ? 1 : 0) - from[k]) / way[k]);
        }
        EXPECT_LT((end - from - share * way).norm(), 1e-9);
    }
}

TEST(TraceGeodesic, ClosesAroundACylinder) {
    const Ground ground(test::cylinder(20, 6, 1, 2));
    const double circumference = 20 * 2 * std::sin(std::numbers::pi / 20);
    std::mt19937 random(3);
    for (int run = 0; run < 20; ++run) {
        const SurfacePoint start = random_point(ground, random);
        const Vector3 from = ground.position(start);
        Vector3 around = Vector3::UnitZ().cross(
            (ground.corner(start.triangle, 1) - ground.corner(start.triangle, 0))
                .cross(ground.corner(start.triangle, 2) - ground.corner(start.triangle, 0)));
        around.normalize();
        EXPECT_LT((ground.walk(start, circumference * around) - from).norm(), 1e-9);
        EXPECT_LT((ground.walk(start, -2 * circumference * around) - from).norm(), 1e-9);
        // Along a helix it comes back above or below.
        const double rise = from[2] > ground.mesh.V.col(2).mean() ? -0.5 : 0.5;
        const Vector3 end = ground.walk(start, circumference * around + rise * Vector3::UnitZ());
        EXPECT_LT((end - from - rise * Vector3::UnitZ()).norm(), 1e-9);
    }
}

TEST(TraceGeodesic, UnfoldsTheEdgesOfACube) {
    const Ground ground(test::cube(3));
    for (int t = 0; t < ground.mesh.F.rows(); ++t) {
        const SurfacePoint start{t, Vector3(0.5, 0.3, 0.2)};
        const Vector3 from = ground.position(start);
        for (int axis = 0; axis < 3; ++axis) {
            if (std::abs(std::abs(from[axis]) - 1) < 1e-9) continue;
            // Around four sides of edge length 2; half way, straight behind.
            EXPECT_LT((ground.walk(start, 8 * Vector3::Unit(axis)) - from).norm(), 1e-9);
            Vector3 behind = from;
            behind[axis] = -from[axis];
            for (int k = 0; k < 3; ++k) {
                if (std::abs(std::abs(from[k]) - 1) < 1e-9) behind[k] = -from[k];
            }
            EXPECT_LT((ground.walk(start, 4 * Vector3::Unit(axis)) - behind).norm(), 1e-9);
        }
    }
}

TEST(TraceGeodesic, StaysWhereThereIsNoWayToGo) {
    const Ground ground(test::sphere(2));
    const SurfacePoint start{17, Vector3(0.2, 0.3, 0.5)};
    const SurfacePoint end = trace_geodesic(ground.topology, ground.metric, start, Vector2::Zero());
    EXPECT_EQ(end.triangle, start.triangle);
    EXPECT_LT((end.barycentric - start.barycentric).norm(), 1e-15);
}

}  // namespace
}  // namespace kinequad
