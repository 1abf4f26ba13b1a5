#include "kinequad/measure/stretch_alignment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinequad/mesh/intrinsic_metric.h"
#include "quad_grid.h"
#include "support/shapes.h"

namespace kinequad {
namespace {

using test::degree;

Eigen::Matrix3d turn(double angle) {
    Eigen::Matrix3d R;
    R << std::cos(angle), -std::sin(angle), 0, std::sin(angle), std::cos(angle), 0, 0, 0, 1;
    return R;
}

/// Stretches the plane by `factor` in the direction at `angle`.
Eigen::Matrix3d stretch(double angle, double factor) {
    return turn(angle) * Eigen::Vector3d(factor, 1, 1).asDiagonal() * turn(-angle);
}

/// The unit square of triangles under a grid of quads turned by `angle` about its middle, large
/// enough to cover it.
StretchReference turned_grid(double angle) {
    const TriangleMesh square = test::square(6);
    const test::QuadGrid grid = test::quad_grid(40);
    const Eigen::RowVector3d middle(0.5, 0.5, 0);
    const Positions X =
        (2 * (grid.X.rowwise() - middle) * turn(angle).transpose()).rowwise() + middle;
    const Topology topology = build_topology(square.F, static_cast<int>(square.V.rows()));
    return {square.V, square.F, triangle_sides(topology, metric_of(topology, square.V)), X,
            make_polygons(grid.Q)};
}

double alignment_with(const StretchReference& reference, const Eigen::Matrix3d& motion) {
    StretchAlignment alignment(reference);
    alignment.add_frame(reference.V * motion.transpose());
    return alignment.degrees();
}

TEST(StretchAlignment, IsTheAngleBetweenStretchAndEdges) {
    for (const double angle : {0.0, 10.0, 45.0}) {
        const StretchReference reference = turned_grid(angle * degree);
        EXPECT_NEAR(alignment_with(reference, stretch(0, 1.7)), angle, 1e-6);
        EXPECT_NEAR(alignment_with(reference, stretch(90 * degree, 1.2)), angle, 1e-6);
        EXPECT_NEAR(alignment_with(reference, stretch(angle * degree, 0.6)), 0, 1e-6);
    }
    EXPECT_NEAR(alignment_with(turned_grid(80 * degree), stretch(0, 1.7)), 10, 1e-6);
}

TEST(StretchAlignment, IsHalfOfTheRangeForUniformDirections) {
    const StretchReference reference = turned_grid(0.3);
    StretchAlignment alignment(reference);
    const int frames = 60;
    for (int k = 0; k < frames; ++k) {
        const double angle = 0.3 + k * (90.0 / frames) * degree;
        alignment.add_frame(reference.V * stretch(angle, 1.5).transpose());
    }
    EXPECT_NEAR(alignment.degrees(), 22.5, 1e-6);
}

TEST(StretchAlignment, WeighsByStretch) {
    // 10 degrees with stretch 1 and 40 with stretch 3.
    const StretchReference reference = turned_grid(10 * degree);
    StretchAlignment alignment(reference);
    alignment.add_frame(reference.V * stretch(0, 2));
    alignment.add_frame(reference.V * stretch(50 * degree, 4));
    EXPECT_NEAR(alignment.degrees(), (10.0 + 3 * 40) / 4, 1e-6);
}

TEST(StretchAlignment, WeighsByArea) {
    // One half stretched along the edges, a tenth of the other across them by 30 degrees.
    StretchReference reference = turned_grid(0);
    reference.V.resize(6, 3);
    reference.V << 0, 0, 0, 0.4, 0, 0, 0, 0.4, 0, 0.6, 0.6, 0, 0.8, 0.6, 0, 0.6, 0.8, 0;
    reference.F.resize(2, 3);
    reference.F << 0, 1, 2, 3, 4, 5;
    const Topology topology = build_topology(reference.F, 6);
    reference.sides = triangle_sides(topology, metric_of(topology, reference.V));
    Positions frame = reference.V;
    frame.topRows(3) = reference.V.topRows(3) * stretch(0, 2);
    frame.bottomRows(3) = reference.V.bottomRows(3) * stretch(30 * degree, 2);
    StretchAlignment alignment(reference);
    alignment.add_frame(frame);
    EXPECT_NEAR(alignment.degrees(), (4 * 0.0 + 1 * 30.0) / 5, 1e-6);
}

TEST(StretchAlignment, ReadsTheCrossInTheShapeAtRest) {
    // Quads and triangles are matched in a sheared pose; at rest the quads are a straight grid.
    StretchReference reference = turned_grid(0);
    Eigen::Matrix3d shear = Eigen::Matrix3d::Identity();
    shear(0, 1) = 0.5;
    const Positions rest = reference.V;
    reference.V = rest * shear.transpose();
    reference.X = reference.X * shear.transpose();
    StretchAlignment alignment(reference);
    alignment.add_frame(rest * stretch(0, 1.5));
    EXPECT_NEAR(alignment.degrees(), 0, 1e-6);
}

TEST(StretchAlignment, IsUnknownWithoutStretch) {
    const StretchReference reference = turned_grid(0);
    StretchAlignment alignment(reference);
    EXPECT_TRUE(std::isnan(alignment.degrees()));
    alignment.add_frame(2 * reference.V);
    EXPECT_TRUE(std::isnan(alignment.degrees()) || alignment.degrees() <= 45);
}

TEST(StretchAlignment, LeavesCollapsedTrianglesOut) {
    const StretchReference reference = turned_grid(10 * degree);
    Positions frame = reference.V * stretch(0, 2);
    frame.row(8) = frame.row(9);
    StretchAlignment alignment(reference);
    alignment.add_frame(frame);
    EXPECT_TRUE(std::isfinite(alignment.degrees()));
    StretchAlignment flat(reference);
    flat.add_frame(reference.V * Eigen::Vector3d(1, 0, 1).asDiagonal());
    EXPECT_TRUE(std::isnan(flat.degrees()));
}

TEST(StretchAlignment, DoesNotDependOnTheNumberOfThreads) {
    const TriangleMesh torus = test::torus(60, 30);
    const TriangleMesh coarse = test::torus(23, 11);
    Quads Q(coarse.F.rows() / 2, 4);
    for (Eigen::Index q = 0; q < Q.rows(); ++q) {
        Q.row(q) << coarse.F(2 * q, 0), coarse.F(2 * q, 1), coarse.F(2 * q, 2),
            coarse.F(2 * q + 1, 2);
    }
    const Topology topology = build_topology(torus.F, static_cast<int>(torus.V.rows()));
    const StretchReference reference{torus.V, torus.F,
                                     triangle_sides(topology, metric_of(topology, torus.V)),
                                     coarse.V, make_polygons(Q)};
    Positions frame = torus.V;
    for (Eigen::Index i = 0; i < frame.rows(); ++i)
        frame(i, 2) *= 1 + 0.5 * std::sin(3 * frame(i, 0));
    const auto degrees_with = [&](int threads) {
        Context context;
        context.threads = threads;
        StretchAlignment alignment(reference, context);
        alignment.add_frame(frame, context);
        return alignment.degrees();
    };
    EXPECT_EQ(degrees_with(1), degrees_with(2));
    EXPECT_EQ(degrees_with(1), degrees_with(8));
    EXPECT_GT(degrees_with(1), 1);
}

}  // namespace
}  // namespace kinequad
