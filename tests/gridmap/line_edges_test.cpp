#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinequad/field/compute_cross_field.h"
#include "kinequad/gridmap/compute_grid_map.h"
#include "kinequad/mesh/feature_edges.h"
#include "support/shapes.h"

namespace kinequad {
namespace {

/// Edges whose two ends satisfy a condition.
template <class Condition>
std::vector<int> edges_where(const Topology& topology, const Positions& V,
                             const Condition& condition) {
    std::vector<int> edges;
    for (int e = 0; e < topology.edge_count; ++e) {
        const int h = topology.edge_half_edge[static_cast<std::size_t>(e)];
        const Vector3 a = V.row(topology.origin[static_cast<std::size_t>(h)]).transpose();
        const Vector3 b = V.row(topology.target(h)).transpose();
        if (condition(a) && condition(b)) edges.push_back(e);
    }
    return edges;
}

/// The map of the smoothest field along `lines`, which are lines of `options` by `kind`.
GridMap map_along(const TriangleMesh& mesh, const std::vector<int>& lines, int vertices,
                  std::vector<int> GridMapOptions::*kind) {
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    const IntrinsicMetric metric = metric_of(topology, mesh.V);
    CrossFieldOptions field_options;
    field_options.feature_edges = lines;
    const CrossField field = compute_cross_field(topology, metric, {}, field_options, {});
    GridMapOptions options;
    options.vertex_count = vertices;
    options.*kind = lines;
    return compute_grid_map(topology, metric, field, options, {});
}

GridMap map_with_lines(const TriangleMesh& mesh, const std::vector<int>& lines, int vertices) {
    return map_along(mesh, lines, vertices, &GridMapOptions::line_edges);
}

GridMap map_with_features(const TriangleMesh& mesh, const std::vector<int>& features,
                          int vertices) {
    return map_along(mesh, features, vertices, &GridMapOptions::feature_edges);
}

void expect_lines_kept(const GridMap& map, std::size_t least_count) {
    const GridMapReport report = verify_grid_map(map);
    EXPECT_TRUE(report.valid());
    EXPECT_EQ(report.unaligned_edges, 0);
    EXPECT_EQ(map.lost_line_edges, 0);
    EXPECT_GE(std::count(map.is_line.begin(), map.is_line.end(), 1), 2 * least_count);
}

TEST(LineEdges, TheEquatorOfASphereIsAnIntegerLine) {
    const TriangleMesh mesh = test::sphere(4);
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    const std::vector<int> equator =
        edges_where(topology, mesh.V, [](const Vector3& p) { return std::abs(p[0]) < 1e-9; });
    ASSERT_GT(equator.size(), 20U);
    for (const int vertices : {100, 400, 1500}) {
        SCOPED_TRACE(vertices);
        expect_lines_kept(map_with_lines(mesh, equator, vertices), equator.size());
    }
}

TEST(LineEdges, LinesMayEndCrossAndReachTheBoundary) {
    const TriangleMesh mesh = test::square(16);
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    const double low = mesh.V.minCoeff();
    const double size = mesh.V.maxCoeff() - low;
    const auto share = [&](double x) { return (x - mesh.V.col(0).minCoeff()) / size; };
    // A whole line from side to side, and one across it that ends inside.
    std::vector<int> lines = edges_where(
        topology, mesh.V, [&](const Vector3& p) { return std::abs(share(p[1]) - 0.5) < 1e-9; });
    const std::vector<int> across = edges_where(topology, mesh.V, [&](const Vector3& p) {
        return std::abs(share(p[0]) - 0.25) < 1e-9 && share(p[1]) < 0.8 && share(p[1]) > 0.2;
    });
    lines.insert(lines.end(), across.begin(), across.end());
    ASSERT_EQ(lines.size(), 16 + across.size());
    expect_lines_kept(map_with_lines(mesh, lines, 300), lines.size());
}

TEST(LineEdges, ThoseThatNoMapHasAreCounted) {
    // Three lines leave the middle within a right angle: that is one more than a map can tell
    // apart.
    const TriangleMesh mesh = test::square(16);
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    const double low = mesh.V.minCoeff();
    const double size = mesh.V.maxCoeff() - low;
    const auto from_middle = [&](const Vector3& p, int k) { return (p[k] - low) / size - 0.5; };
    const auto is_on = [&](const Vector3& p) {
        const double x = from_middle(p, 0);
        const double y = from_middle(p, 1);
        const bool is_near = std::max(std::abs(x), std::abs(y)) < 0.3;
        return is_near && (std::abs(x) < 1e-9 || std::abs(y) < 1e-9 || std::abs(x - y) < 1e-9);
    };
    std::vector<int> lines;
    for (const int e : edges_where(topology, mesh.V, is_on)) {
        const int h = topology.edge_half_edge[static_cast<std::size_t>(e)];
        const Vector3 middle = (mesh.V.row(topology.origin[static_cast<std::size_t>(h)]) +
                                mesh.V.row(topology.target(h))) /
                               2;
        if (is_on(middle)) lines.push_back(e);
    }
    const GridMap map = map_with_lines(mesh, lines, 300);
    EXPECT_TRUE(verify_grid_map(map).valid());
    EXPECT_GT(map.lost_line_edges, 0);
    EXPECT_LT(map.lost_line_edges, static_cast<int>(lines.size()));
}

TEST(FeatureLines, AllEdgesOfACubeAreIntegerLines) {
    const TriangleMesh mesh = test::cube(6);
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    const std::vector<int> edges = find_feature_edges(topology, mesh.V, 40);
    ASSERT_EQ(edges.size(), 12U * 6);
    for (const int vertices : {8, 100, 800}) {
        SCOPED_TRACE(vertices);
        const GridMap map = map_with_features(mesh, edges, vertices);
        EXPECT_TRUE(verify_grid_map(map).valid());
        EXPECT_EQ(map.feature_edges, edges);
    }
}

TEST(FeatureLines, CrossingLinesInANarrowStripLeaveAValidMap) {
    const int n = 16;
    TriangleMesh mesh = test::square(n);
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    const auto low = mesh.V.colwise().minCoeff().eval();
    const double size = mesh.V.col(0).maxCoeff() - low[0];
    const auto cell = [&](const Vector3& p, int k) { return (p[k] - low[k]) / size * n; };
    const auto on_row = [&](const Vector3& p) { return std::abs(cell(p, 1) - 8) < 1e-6; };
    std::vector<int> lines = edges_where(topology, mesh.V, on_row);
    for (int v = 0; v < mesh.V.rows(); ++v) {
        const Vector3 p = mesh.V.row(v).transpose();
        // Bend the next row down to the line on the left.
        if (std::abs(cell(p, 1) - 9) < 1e-6 && cell(p, 0) < 8.5)
            mesh.V(v, 1) -= 0.8 * size / n * (1 - cell(p, 0) / 8.5);
    }
    const std::vector<int> across = edges_where(topology, mesh.V, [&](const Vector3& p) {
        return std::abs(cell(p, 0) - 4) < 1e-6 || std::abs(cell(p, 0) - 5) < 1e-6;
    });
    lines.insert(lines.end(), across.begin(), across.end());
    std::sort(lines.begin(), lines.end());
    lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
    const GridMap map = map_with_features(mesh, lines, 300);
    EXPECT_TRUE(verify_grid_map(map).valid());
    EXPECT_TRUE(std::includes(lines.begin(), lines.end(), map.feature_edges.begin(),
                              map.feature_edges.end()));
}

}  // namespace
}  // namespace kinequad
