#include "kinequad/field/trace_streamlines.h"

#include <gtest/gtest.h>

#include "kinequad/core/index.h"
#include "kinequad/field/compute_cross_field.h"
#include "support/shapes.h"

namespace kinequad {
namespace {

/// All streamlines of the smoothest field of a mesh, as points in space.
std::vector<Positions> lines_of(const TriangleMesh& mesh, double length) {
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    const IntrinsicMetric metric = metric_of(topology, mesh.V);
    const CrossField field = compute_cross_field(topology, metric, {}, {}, {});
    std::vector<Positions> result;
    for (const std::vector<SurfacePoint>& line :
         trace_streamlines(topology, metric, field, length)) {
        Positions& points = result.emplace_back(static_cast<Eigen::Index>(line.size()), 3);
        for (std::size_t i = 0; i < line.size(); ++i) {
            points.row(static_cast<Eigen::Index>(i)) =
                position_of(line[i], mesh.V, mesh.F).transpose();
        }
    }
    return result;
}

TEST(TraceStreamlines, AreStraightAlongTheSidesOfASquare) {
    const std::vector<Positions> lines = lines_of(test::square(12), 100);
    ASSERT_GE(lines.size(), 4U);
    for (const Positions& line : lines) {
        const Eigen::RowVector3d extent = line.colwise().maxCoeff() - line.colwise().minCoeff();
        // One side long, without width.
        EXPECT_LT(extent.minCoeff(), 1e-9);
        EXPECT_LT(extent.sum() - extent.maxCoeff(), 1e-9 + 1e-6 * extent.maxCoeff());
        EXPECT_GT(extent.maxCoeff(), 0.99 * test::square(12).V.colwise().maxCoeff().maxCoeff());
    }
}

TEST(TraceStreamlines, AreConnectedAndAsLongAsAsked) {
    const TriangleMesh sphere = test::sphere(3);
    constexpr double length = 0.5;
    double longest_edge = 0;
    for (Eigen::Index t = 0; t < sphere.F.rows(); ++t) {
        longest_edge = std::max(
            longest_edge, (sphere.V.row(sphere.F(t, 0)) - sphere.V.row(sphere.F(t, 1))).norm());
    }
    for (const Positions& line : lines_of(sphere, length)) {
        double sum = 0;
        for (Eigen::Index i = 1; i < line.rows(); ++i) {
            const double step = (line.row(i) - line.row(i - 1)).norm();
            EXPECT_LT(step, 1.2 * longest_edge);
            sum += step;
        }
        EXPECT_GT(sum, 2 * length - 1e-9);
        EXPECT_LT(sum, 2 * (length + 1.2 * longest_edge));
    }
}

}  // namespace
}  // namespace kinequad
