#include "kinequad/mesh/split_along_level.h"

#include <gtest/gtest.h>

#include "support/shapes.h"

namespace kinequad {
namespace {

struct Split {
    Topology topology;
    IntrinsicMetric metric;
    LevelSplit split;
    Positions V;  ///< of the split mesh
};

Split split(const TriangleMesh& mesh, const std::function<double(const Vector3&)>& height_of,
            double snap_share, SnapUnit unit = SnapUnit::crossed_edge) {
    Split result;
    result.topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    result.metric = metric_of(result.topology, mesh.V);
    Eigen::VectorXd height(mesh.V.rows());
    for (Eigen::Index v = 0; v < height.size(); ++v) height[v] = height_of(mesh.V.row(v));
    result.split = split_along_level(result.topology, result.metric, height, snap_share, unit);
    result.V.resize(result.split.mesh.vertex_count, 3);
    const std::vector<SurfacePoint> points = vertex_points(result.split.mesh);
    for (std::size_t v = 0; v < points.size(); ++v) {
        result.V.row(static_cast<Eigen::Index>(v)) =
            position_of(points[v], mesh.V, mesh.F).transpose();
    }
    return result;
}

/// The triangles on one side, over the vertices of the whole.
Triangles side_of(const LevelSplit& split, int side) {
    std::vector<int> rows;
    for (std::size_t t = 0; t < split.side.size(); ++t) {
        if (split.side[t] == side) rows.push_back(static_cast<int>(t));
    }
    return split.mesh.F(rows, Eigen::all);
}

TEST(SplitAlongLevel, CutsASphereIntoTwoDiscsOfTheSameArea) {
    const Split it = split(
        test::sphere(3), [](const Vector3& p) { return p[2] + 0.3 * p[0] + 0.0713; }, 0.2);
    const Topology whole = build_topology(it.split.mesh.F, it.split.mesh.vertex_count);
    EXPECT_EQ(count_surface(whole).euler_characteristic, 2);
    EXPECT_NEAR(triangle_areas(whole, metric_of(whole, it.V)).sum(),
                triangle_areas(it.topology, it.metric).sum(), 1e-9);
    for (const int side : {1, -1}) {
        const Topology half = build_topology(side_of(it.split, side), it.split.mesh.vertex_count);
        const SurfaceCounts counts = count_surface(half);
        EXPECT_EQ(counts.euler_characteristic, 1);
        EXPECT_EQ(counts.boundary_loops, 1);
        // Exactly the boundary lies on the level.
        for (int v = 0; v < half.vertex_count; ++v) {
            if (half.vertex_half_edge[static_cast<std::size_t>(v)] < 0) continue;
            EXPECT_EQ(half.is_boundary_vertex(v),
                      it.split.is_on_level[static_cast<std::size_t>(v)] != 0);
        }
    }
}

TEST(SplitAlongLevel, TakesVerticesWithinRoundingErrorsExactly) {
    // The sphere of the tests has a ring of vertices with x = 0.
    const Split it = split(
        test::sphere(3), [](const Vector3& p) { return p[0] + (p[1] > p[2] ? 1e-13 : -1e-13); },
        0.2);
    EXPECT_EQ(it.split.mesh.vertex_count, it.topology.vertex_count);
    for (int v = 0; v < it.split.mesh.vertex_count; ++v) {
        EXPECT_EQ(it.split.is_on_level[static_cast<std::size_t>(v)] != 0,
                  std::abs(it.V(v, 0)) < 1e-9);
    }
}

TEST(SplitAlongLevel, LeavesNoTriangleMuchThinner) {
    const auto least_angle = [](const Topology& topology, const IntrinsicMetric& metric) {
        double least = 10;
        for (int t = 0; t < topology.triangle_count; ++t) {
            for (const double angle : corner_angles(side_lengths(topology, metric, t))) {
                least = std::min(least, angle);
            }
        }
        return least;
    };
    for (const double shift : {0.001, 0.01, 0.03, 0.05, 0.11}) {
        const Split it = split(
            test::sphere(3), [&](const Vector3& p) { return p[1] - 0.2 * p[0] + shift; }, 0.2);
        const Topology whole = build_topology(it.split.mesh.F, it.split.mesh.vertex_count);
        EXPECT_GT(least_angle(whole, metric_of(whole, it.V)),
                  0.08 * least_angle(it.topology, it.metric))
            << shift;
    }
}

/// Distance of the inserted curve, at its farthest, from a straight line through long triangles.
TEST(SplitAlongLevel, KeepsALineStraightThroughLongTriangles) {
    constexpr double share = 0.2;
    constexpr double stretch = 8;
    TriangleMesh mesh = test::square(10);
    const double width = 0.1;
    mesh.V.col(0) *= stretch;
    for (const double slope : {0.05, 0.1, 0.35}) {
        const Vector3 normal = Vector3(1, -slope, 0).normalized();
        const auto height = [&](const Vector3& p) { return normal.dot(p - Vector3(3.9, 0, 0)); };
        const auto farthest = [&](SnapUnit unit) {
            const Split it = split(mesh, height, share, unit);
            double result = 0;
            for (Eigen::Index v = 0; v < it.V.rows(); ++v) {
                if (it.split.is_on_level[static_cast<std::size_t>(v)] == 0) continue;
                result = std::max(result, std::abs(height(it.V.row(v).transpose())));
            }
            return result;
        };
        EXPECT_LE(farthest(SnapUnit::shortest_edge), share * width + 1e-12) << slope;
        EXPECT_GT(farthest(SnapUnit::crossed_edge), 2 * share * width) << slope;
    }
}

}  // namespace
}  // namespace kinequad
