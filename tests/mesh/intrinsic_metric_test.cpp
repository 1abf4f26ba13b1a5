#include "kinequad/mesh/intrinsic_metric.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <numbers>

#include "support/shapes.h"

namespace kinequad {
namespace {

constexpr double pi = std::numbers::pi;

using Sides = std::array<double, 3>;

struct Surface {
    Topology topology;
    IntrinsicMetric metric;
};

Surface surface_of(const TriangleMesh& mesh) {
    Surface result;
    result.topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    result.metric = metric_of(result.topology, mesh.V);
    return result;
}

/// The angle brought into (-pi, pi].
double wrapped(double angle) { return std::remainder(angle, 2 * pi); }

TEST(IntrinsicMetric, LengthsOfTheUnitSquare) {
    const Surface square = surface_of(test::square(1));
    const Sides sides = side_lengths(square.topology, square.metric, 0);
    EXPECT_DOUBLE_EQ(sides[0], 1);
    EXPECT_DOUBLE_EQ(sides[1], 1);
    EXPECT_DOUBLE_EQ(sides[2], std::sqrt(2.0));
}

TEST(IntrinsicMetric, TriangleClosedForms) {
    EXPECT_DOUBLE_EQ(triangle_area({3, 4, 5}), 6);
    const Sides angles = corner_angles({3, 4, 5});
    // Half-edge 0 runs from corner 0 to corner 1, so that corner 1 lies between sides 3 and 4.
    EXPECT_NEAR(angles[0], std::atan2(4, 3), 1e-15);
    EXPECT_NEAR(angles[1], pi / 2, 1e-15);
    EXPECT_NEAR(angles[2], std::atan2(3, 4), 1e-15);
}

TEST(IntrinsicMetric, ANeedleKeepsItsDigits) {
    // Heron's formula as it stands in books returns 0 here.
    const double thin = 1e-9;
    EXPECT_NEAR(triangle_area({1, 1, thin}) / (0.5 * thin), 1, 1e-12);
}

TEST(IntrinsicMetric, BrokenTriangleInequalityGivesAFlatTriangle) {
    const Sides sides = {3, 1, 1};
    EXPECT_EQ(triangle_area(sides), 0);
    const Sides angles = corner_angles(sides);
    EXPECT_EQ(angles[0], 0);
    EXPECT_EQ(angles[1], 0);
    EXPECT_EQ(angles[2], pi);
    EXPECT_EQ(lay_out_triangle(sides)(1, 2), 0);
}

TEST(IntrinsicMetric, RandomTrianglesAgreeWithTheirLayout) {
    EXPECT_TRUE(rc::check("layout, area, angles and directions say the same", [] {
        const auto side =
            rc::gen::map(rc::gen::inRange(1000, 100000), [](int i) { return i / 1000.0; });
        const double a = *side;
        const double b = *side;
        const double between = std::fabs(a - b) + 1e-3;
        const double c = between + (a + b - 1e-3 - between) * *rc::gen::inRange(0, 1000) / 1000.0;
        const Sides sides = {a, b, c};
        const Eigen::Matrix<double, 2, 3> corner = lay_out_triangle(sides);
        const Sides directions = half_edge_directions(sides);
        const Sides angles = corner_angles(sides);
        RC_ASSERT(corner(1, 2) >= 0);
        RC_ASSERT(std::fabs(angles[0] + angles[1] + angles[2] - pi) < 1e-12);
        const Vector2 first = corner.col(1) - corner.col(0);
        const Vector2 last = corner.col(2) - corner.col(0);
        const double area = 0.5 * (first.x() * last.y() - first.y() * last.x());
        RC_ASSERT(std::fabs(area - triangle_area(sides)) <= 1e-12 * a * c);
        for (int k = 0; k < 3; ++k) {
            const auto i = static_cast<std::size_t>(k);
            const Vector2 half_edge = corner.col((k + 1) % 3) - corner.col(k);
            RC_ASSERT(std::fabs(half_edge.norm() - sides[i]) < 1e-6 * (a + b + c));
            const Vector2 expected =
                sides[i] * Vector2(std::cos(directions[i]), std::sin(directions[i]));
            RC_ASSERT((half_edge - expected).norm() < 1e-6 * (a + b + c));
        }
    }));
}

TEST(IntrinsicMetric, AngleDefectsSumToTwoPiTimesTheEulerCharacteristic) {
    for (const TriangleMesh& mesh : {test::tetrahedron(), test::cube(3), test::sphere(3),
                                     test::torus(20, 9), test::square(4), test::cylinder(8, 3)}) {
        const Surface surface = surface_of(mesh);
        const double sum = angle_defects(surface.topology, surface.metric).sum();
        EXPECT_NEAR(sum, 2 * pi * count_surface(surface.topology).euler_characteristic, 1e-9);
    }
}

TEST(IntrinsicMetric, DefectsOfTheCubeSitInItsCorners) {
    const TriangleMesh mesh = test::cube(3);
    const Surface cube = surface_of(mesh);
    const Eigen::VectorXd defects = angle_defects(cube.topology, cube.metric);
    for (int v = 0; v < mesh.V.rows(); ++v) {
        const bool corner = mesh.V.row(v).cwiseAbs().sum() > 3 - 1e-9;
        EXPECT_NEAR(defects[v], corner ? pi / 2 : 0, 1e-12) << "vertex " << v;
    }
}

TEST(IntrinsicMetric, AreasAddUp) {
    const Surface cube = surface_of(test::cube(4));
    EXPECT_NEAR(triangle_areas(cube.topology, cube.metric).sum(), 24, 1e-12);
    const Surface cylinder = surface_of(test::cylinder(400, 2));
    EXPECT_NEAR(triangle_areas(cylinder.topology, cylinder.metric).sum(), 4 * pi, 1e-3);
}

TEST(IntrinsicMetric, FrameRotationIsUndoneOnTheWayBack) {
    const Surface torus = surface_of(test::torus(11, 6));
    for (int h = 0; h < 3 * torus.topology.triangle_count; ++h) {
        const int other = torus.topology.twin[static_cast<std::size_t>(h)];
        const double there = frame_rotation(torus.topology, torus.metric, h);
        const double back = frame_rotation(torus.topology, torus.metric, other);
        EXPECT_NEAR(wrapped(there + back), 0, 1e-12);
    }
}

TEST(IntrinsicMetric, FrameRotationCarriesTheSharedEdgeToItself) {
    const Surface sphere = surface_of(test::sphere(2));
    for (int h = 0; h < 3 * sphere.topology.triangle_count; ++h) {
        const int other = sphere.topology.twin[static_cast<std::size_t>(h)];
        const auto here = half_edge_directions(side_lengths(sphere.topology, sphere.metric, h / 3));
        const auto there =
            half_edge_directions(side_lengths(sphere.topology, sphere.metric, other / 3));
        const double carried = here[static_cast<std::size_t>(h % 3)] +
                               frame_rotation(sphere.topology, sphere.metric, h);
        EXPECT_NEAR(wrapped(carried - there[static_cast<std::size_t>(other % 3)] - pi), 0, 1e-12);
    }
}

TEST(IntrinsicMetric, ADirectionCarriedAroundAVertexTurnsByTheAngleDefect) {
    for (const TriangleMesh& mesh : {test::tetrahedron(), test::cube(2), test::torus(9, 6)}) {
        const Surface surface = surface_of(mesh);
        const Eigen::VectorXd defects = angle_defects(surface.topology, surface.metric);
        for (int v = 0; v < surface.topology.vertex_count; ++v) {
            double turn = 0;
            for (const int h : outgoing_half_edges(surface.topology, v)) {
                turn += frame_rotation(surface.topology, surface.metric, Topology::previous(h));
            }
            EXPECT_NEAR(wrapped(turn - defects[v]), 0, 1e-10) << "vertex " << v;
        }
    }
}

TEST(IntrinsicMetric, FrameRotationsVanishWhereAllFramesAreParallel) {
    const TriangleMesh mesh = test::square(4);
    const Surface square = surface_of(mesh);
    for (int h = 0; h < 3 * square.topology.triangle_count; ++h) {
        if (square.topology.twin[static_cast<std::size_t>(h)] < 0) continue;
        const auto x_axis_of = [&](int t) {
            const Vector3 axis = mesh.V.row(mesh.F(t, 1)) - mesh.V.row(mesh.F(t, 0));
            return std::atan2(axis.y(), axis.x());
        };
        const int other = square.topology.twin[static_cast<std::size_t>(h)];
        // A fixed direction of the plane has angle -x_axis in a triangle's frame, plus a constant.
        const double expected = x_axis_of(h / 3) - x_axis_of(other / 3);
        EXPECT_NEAR(wrapped(frame_rotation(square.topology, square.metric, h) - expected), 0,
                    1e-12);
    }
}

TEST(IntrinsicMetric, ScalesWithTheShape) {
    TriangleMesh mesh = test::torus(9, 6);
    const Surface surface = surface_of(mesh);
    for (const double scale : {1e-8, 1e8}) {
        const Surface scaled = surface_of({scale * mesh.V, mesh.F});
        EXPECT_TRUE(scaled.metric.edge_length.isApprox(scale * surface.metric.edge_length, 1e-12));
        EXPECT_TRUE(angle_defects(scaled.topology, scaled.metric)
                        .isApprox(angle_defects(surface.topology, surface.metric), 1e-10));
        EXPECT_TRUE(
            triangle_areas(scaled.topology, scaled.metric)
                .isApprox(scale * scale * triangle_areas(surface.topology, surface.metric), 1e-10));
    }
}

}  // namespace
}  // namespace kinequad
