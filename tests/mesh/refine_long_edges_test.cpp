#include "kinequad/mesh/refine_long_edges.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinequad/mesh/widen_flat_triangles.h"
#include "support/shapes.h"

namespace kinequad::test {
namespace {

Positions positions_of(const RefinedMesh& refined, const TriangleMesh& input) {
    Positions V(refined.vertex_count, 3);
    const std::vector<SurfacePoint> points = vertex_points(refined);
    for (int v = 0; v < refined.vertex_count; ++v) {
        V.row(v) = position_of(points[static_cast<std::size_t>(v)], input.V, input.F).transpose();
    }
    return V;
}

RefinedMesh refine(const TriangleMesh& mesh, double longest, int least_triangles = 1) {
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    RefineOptions options;
    options.longest_edge = longest;
    options.least_triangles = least_triangles;
    return refine_long_edges(topology, metric_of(topology, mesh.V), options, {});
}

/// What any refinement has to be: the same surface, vertices kept, no edge too long.
void expect_refines(const RefinedMesh& refined, const TriangleMesh& mesh, double longest) {
    const Positions V = positions_of(refined, mesh);
    EXPECT_EQ(V.topRows(mesh.V.rows()), mesh.V);
    const Topology before = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    const Topology after = build_topology(refined.F, refined.vertex_count);
    EXPECT_EQ(count_surface(after).euler_characteristic,
              count_surface(before).euler_characteristic);
    EXPECT_EQ(count_surface(after).boundary_loops, count_surface(before).boundary_loops);
    const IntrinsicMetric metric = metric_of(after, V);
    EXPECT_LE(metric.edge_length.maxCoeff(), longest * (1 + 1e-12));
    const Eigen::VectorXd areas = triangle_areas(after, metric);
    EXPECT_GT(areas.minCoeff(), 0);
    EXPECT_NEAR(areas.sum(), triangle_areas(before, metric_of(before, mesh.V)).sum(), 1e-9);
    for (int e = 0; e < after.edge_count; ++e) {
        const int h = after.edge_half_edge[static_cast<std::size_t>(e)];
        const bool is_chord = !after.is_boundary_edge(e) &&
                              after.is_boundary_vertex(after.origin[static_cast<std::size_t>(h)]) &&
                              after.is_boundary_vertex(after.target(h));
        EXPECT_FALSE(is_chord) << "edge " << e;
    }
}

TEST(RefineLongEdges, KeepsTheSurface) {
    for (const TriangleMesh& mesh :
         {cube(), tetrahedron(), square(1), cylinder(4, 1), torus(3, 3)}) {
        for (const double longest : {1.0, 0.3, 0.07}) {
            expect_refines(refine(mesh, longest), mesh, longest);
        }
    }
}

TEST(RefineLongEdges, LeavesAFineMeshAlone) {
    const TriangleMesh mesh = sphere(3);
    EXPECT_EQ(refine(mesh, 1).F, mesh.F);
}

TEST(RefineLongEdges, GivesSmallPartsTrianglesEnough) {
    TriangleMesh mesh;
    mesh.V.resize(3, 3);
    mesh.V << 0, 0, 0, 1, 0, 0, 0, 1, 0;
    mesh.F.resize(1, 3);
    mesh.F << 0, 1, 2;
    const RefinedMesh refined = refine(mesh, 100, 64);
    EXPECT_GE(refined.F.rows(), 64);
    expect_refines(refined, mesh, 1);
}

TEST(RefineLongEdges, NeedlesGetNoThinnerThanTheyAre) {
    // 1000 long, 1 wide: cut about every 10 along both sides, not 3^7 times.
    TriangleMesh mesh;
    mesh.V.resize(3, 3);
    mesh.V << 0, 0, 0, 1000, 0, 0, 1000, 1, 0;
    mesh.F.resize(1, 3);
    mesh.F << 0, 1, 2;
    const RefinedMesh refined = refine(mesh, 10);
    EXPECT_LT(refined.F.rows(), 1000);
    expect_refines(refined, mesh, 10);
}

TEST(RefineLongEdges, StopsAtItsLimit) {
    const TriangleMesh mesh = cube();
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    RefineOptions options;
    options.longest_edge = 1e-9;
    options.most_triangles = 5000;
    const RefinedMesh refined =
        refine_long_edges(topology, metric_of(topology, mesh.V), options, {});
    EXPECT_LE(refined.F.rows(), 5000);
    EXPECT_GT(refined.F.rows(), 4000);
}

TEST(WidenFlatTriangles, GivesEveryTriangleAnglesAndLeavesSoundOnesAlone) {
    TriangleMesh mesh = sphere(1);
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    const IntrinsicMetric sound = metric_of(topology, mesh.V);
    EXPECT_EQ(widen_flat_triangles(topology, sound).edge_length, sound.edge_length);
    mesh.V.row(mesh.F(0, 1)) = mesh.V.row(mesh.F(0, 0));
    const IntrinsicMetric flat = metric_of(topology, mesh.V);
    const IntrinsicMetric widened = widen_flat_triangles(topology, flat);
    EXPECT_LE((widened.edge_length - flat.edge_length).maxCoeff(),
              1.1e-6 * flat.edge_length.mean());
    double sum = 0;
    const Eigen::VectorXd defects = angle_defects(topology, widened);
    for (int t = 0; t < topology.triangle_count; ++t) {
        EXPECT_GT(triangle_area(side_lengths(topology, widened, t)), 0) << t;
    }
    for (Eigen::Index v = 0; v < defects.size(); ++v) sum += defects[v];
    EXPECT_NEAR(sum, 4 * 3.14159265358979, 1e-6);
}

}  // namespace
}  // namespace kinequad::test
