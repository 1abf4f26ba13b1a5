#include <gtest/gtest.h>

#include <cmath>

#include "kinequad/field/compute_cross_field.h"
#include "kinequad/gridmap/compute_grid_map.h"
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

GridMap map_with_lines(const TriangleMesh& mesh, const std::vector<int>& lines, int vertices) {
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    const IntrinsicMetric metric = metric_of(topology, mesh.V);
    CrossFieldOptions field_options;
    field_options.feature_edges = lines;
    const CrossField field = compute_cross_field(topology, metric, {}, field_options, {});
    GridMapOptions options;
    options.vertex_count = vertices;
    options.line_edges = lines;
    return compute_grid_map(topology, metric, field, options, {});
}

void expect_lines_kept(const GridMap& map, std::size_t least_count) {
    const GridMapReport report = verify_grid_map(map);
    EXPECT_TRUE(report.valid());
    EXPECT_EQ(report.unaligned_edges, 0);
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

}  // namespace
}  // namespace kinequad
